/// Poses that the search of a pair missed but its neighbours tell.
#pragma once

#include <vector>

#include "assembly/evidence.hpp"

namespace rejoin::assembly {

/// Links a-b that follow from links a-k and k-b, where the two then touch: aligned and judged as a pair's own candidates are.  Only
/// those that come out at least as likely as not and have not moved from where their neighbours put them; none that a pair has already.
/// \param links  those of a score of 0.3 or more take part, two a pair; of the combinations that touch 1,000 are tried, or eight
///   a piece, those first that are not of two sure links
std::vector<Link> completed_triangles(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                      const Options& options, const Context& context);

}  // namespace rejoin::assembly
