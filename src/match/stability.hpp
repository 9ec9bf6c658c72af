/// Probes of a pose for what its score cannot see.
#pragma once

#include <optional>

#include "match/align.hpp"
#include "match/match.hpp"

namespace rejoin::match {

/// Aligns the pose again with either half of B's broken samples, and after pushes in the direction in which it is held
/// least: along a groove, or the seam of a sherd.
/// \param evidence  of the pose
/// \return all but `margin`, which takes the other candidates; nullopt if too few samples touch
std::optional<Stability> probe(const Joint& joint, const Rigid& pose, const Evidence& evidence);

}  // namespace rejoin::match
