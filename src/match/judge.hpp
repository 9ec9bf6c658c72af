/// What one pose is worth as it stands.
#pragma once

#include "match/align.hpp"
#include "match/match.hpp"

namespace rejoin::match {

/// Whether breaks fit at a pose as those of a sure join do, whatever speaks against it: what fits as fresh breaks is not judged as worn
/// ones, which would hide what speaks against it.
/// \param joint  as fresh breaks
/// \param pose   B -> A, relative to the meshes' origins
bool fits(const Joint& joint, const Rigid& pose);

/// The figures and the score of a pose, by the measures of match(), without any search or alignment: a rough pose, at which the breaks do
/// not touch, has neither.  Of a pose that match() gives, the figures are those that it tells; the score may be a little higher, as match()
/// does not count what its last small steps gain.  Errors by depth maps stay infinite.  There is no verdict: it rests on the pair's other poses.
/// \param pose  B's file coordinates -> A's
Candidate judge(const Fragment& a, const Fragment& b, const Rigid& pose);

}  // namespace rejoin::match
