/// Naiman's experiment: a broken shape is put together again, two pieces at a time.
#pragma once

#include <cstddef>

#include "outline/lcs.hpp"
#include "outline/shatter.hpp"

namespace rejoin::bench {

struct Reassembly {
  bool whole = false;    ///< one piece is left
  double overlap = 0.0;  ///< widest place, pixels, of the true borders as they were placed
  double gap = 0.0;      ///< the same of what is missing of the unbroken shape
  std::size_t joins_true =
      0;  ///< pieces sewn together that were neighbours, and within 2 pixels of their true place
  std::size_t joins_false = 0;  ///< all others
};

/// Every piece is compared with every other; of the candidates those are sewn that fit best, no piece twice; then again
/// with the new pieces until one is left or nothing fits.
/// \param broken  of one object   \param unbroken  the same object in one piece
/// \source naiman 2018, section 8.1
Reassembly reassemble(const outline::Shattered& broken, const outline::Shattered& unbroken,
                      const outline::LcsOptions& options);

}  // namespace rejoin::bench
