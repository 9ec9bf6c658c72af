/// The longest stretches of two borders whose Frechet distance is small.
#pragma once

#include "outline/common_boundary.hpp"

namespace rejoin::outline {

struct FrechetOptions {
  double tolerance = 1.0;  ///< largest Frechet distance, file units
  std::size_t reach = 20;  ///< samples on either side of the moment that give the first pose
  int rounds = 2;          ///< the pose follows from the stretch and the stretch from the pose, so often
};

/// The motion that takes B's samples of a stretch to A's with the least sum of squares: the rigid part of the linear
/// system.  \source zhang 2016, eq. (3); deviation: turn and shift only, by its closed solution
Planar aligned(const PropertyPlot& a, const PropertyPlot& b, const Stretch& stretch);

/// The longest stretch around a moment whose discrete Frechet distance, with B laid on A, is at most the tolerance:
/// reachable cells of the free space, at most kBand samples off the diagonal.
/// \return what meets; fewer than 2 samples if the borders are apart at the moment itself
/// \source zhang 2016, section 5.1
Stretch longest_frechet(const PropertyPlot& a, const PropertyPlot& b, const Moment& moment,
                        const FrechetOptions& options);

/// Samples by which the walk may leave the diagonal.
constexpr long kBand = 12;

}  // namespace rejoin::outline
