/// Poses that the search of a pair missed but its neighbours tell.
#pragma once

#include <vector>

#include "assembly/evidence.hpp"

namespace rejoin::assembly {

/// Links a-b that follow from links a-k and k-b, where the two then touch: aligned and judged as a pair's own candidates are.  Only
/// those that come out at least as likely as not and have not moved from where their neighbours put them; none that a pair has already.
/// \param links  those of a score of 0.3 or more take part, two a pair; the most promising 1,000 combinations are tried
std::vector<Link> completed_triangles(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                      const Options& options, const Context& context);

}  // namespace rejoin::assembly
