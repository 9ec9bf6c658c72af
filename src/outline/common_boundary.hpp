/// The longest stretches of two borders that look alike.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/alignment_moments.hpp"
#include "outline/transport.hpp"

namespace rejoin::outline {

/// Stretches of A's forward and B's backward plot, sample by sample.
struct Stretch {
  std::vector<long>
      a;  ///< samples of A, each one more than the one before; they may lie outside 0 .. size - 1
  std::vector<long> b;  ///< the sample of B that each meets, never falling
  double gain = 0.0;    ///< as Moment::gain, over the stretch
};

struct BoundaryOptions {
  CostWeights weights;
  double epsilon = 0.003;  ///< largest earth mover's cost, share of the borders' length together
  std::size_t bins = 32;   ///< of sand a stretch
  int most_solved = 4;     ///< transport problems solved a stretch; then only the upper bound decides
};

/// The longest stretch around a moment whose earth mover's cost stays within epsilon: enlarged block by block where
/// the cost rises least, then shrunk by the ends that cost more than they add.
/// \source zhang 2016, eq. (2) and section 4.2
Stretch longest_boundary(const PropertyPlot& a, const PropertyPlot& b, const Moment& moment,
                         const BoundaryOptions& options);

}  // namespace rejoin::outline
