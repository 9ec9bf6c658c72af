/// How many chips come off a piece.
#pragma once

#include <cmath>

#include "core/random.hpp"

namespace rejoin::shatter {

/// A whole number from 0 to about twice the mean, those between the ends equally often.
/// \param mean  at least 0; between halves, the next halves below and above take turns at random
inline int chip_count(double mean, Random& random) {
  double most = std::floor(2.0 * mean);
  const double rest = 2.0 * mean - most;
  if (rest > 0.0 && random.uniform() < rest) most += 1.0;
  return static_cast<int>(std::floor(random.uniform(0.0, most) + 0.5));
}

}  // namespace rejoin::shatter
