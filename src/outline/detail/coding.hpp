/// Borders as the sequences that the multi-scale method compares.
#pragma once

#include <span>
#include <vector>

#include "outline/detail/pairing.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline::detail {

/// One piece at one scale.
struct Coded {
  Sequence forward;   ///< turning / the scale's usual turning, cut off at 4
  Sequence backward;  ///< the same run backwards with its sign changed
};

/// How much a straight border of an outline file, whose numbers are rounded, turns from sample to sample at scale k at most, radians.
double straight_turning(std::size_t k);

/// The usual size of turning at scale k of a set: a standard deviation, found from the median of the sizes.  Straight borders of
/// outline files do not count: of torn sheets and strips most of the border is straight.
/// \param pieces     the scales of each piece
/// \param of_pixels  some pieces are from pictures, whose straight borders turn by their pixels' raster
double usual_turning(std::span<const std::vector<ScaleSignal>> pieces, std::size_t k, bool of_pixels);

/// \param usual  usual_turning() of this scale
Coded encode(const ScaleSignal& signal, double usual);

}  // namespace rejoin::outline::detail
