/// What one pose is worth as it stands.
#pragma once

#include "match/align.hpp"
#include "match/match.hpp"

namespace rejoin::match {

/// A pose, judged without any search or alignment: a rough one, at which the breaks do not touch, is worth nothing.
struct Judged {
  Evidence evidence;    ///< weigh()ed, and held back where one piece slides along the other
  double as_rival = 0;  ///< Hypothesis::as_rival
  double fit = 0;       ///< strength() before anything was weighed
};

/// \param pose  B -> A, relative to the meshes' origins
Judged judge(const Joint& joint, const Rigid& pose);

/// As fresh breaks, and as worn ones where these do not fit as those of a sure join do: what fits and is doubted would be hidden by the
/// larger distances.  The stronger counts.  The figures are those that match() tells of its poses; the strength may be a little higher, as
/// match() does not count what its last small steps gain.  There is no verdict: it rests on the pair's other poses.
/// \param pose  B's file coordinates -> A's
Judged judge(const Fragment& a, const Fragment& b, const Rigid& pose);

}  // namespace rejoin::match
