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

/// The usual size of turning at scale k of a set: a standard deviation, found from the median of the sizes.
/// \param pieces  the scales of each piece
double usual_turning(std::span<const std::vector<ScaleSignal>> pieces, std::size_t k);

/// \param usual  usual_turning() of this scale
Coded encode(const ScaleSignal& signal, double usual);

}  // namespace rejoin::outline::detail
