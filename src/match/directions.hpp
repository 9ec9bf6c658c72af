/// Directions in which a fragment may join.
#pragma once

#include <vector>

#include "match/match.hpp"

namespace rejoin::match {

/// One fracture direction.
struct CandidateDirection {
  glm::dvec3 direction{0, 0, 1};  ///< unit, outwards, file axes
  int facet = -1;                 ///< into Fragment::facets; -1: given by the user
};

/// The given directions or, if there are none, the mean normals of the roughest facets: fracture facets (all
/// facets where none counts as fracture) of at least a twentieth of the largest one's area, roughest first; or those of all facets
/// that are named.
/// \param given    any length but 0, file axes
/// \param named    facets that may join whatever their size; empty: any.  \pre the fragment has them
/// \param most     how many directions are taken from facets that are not named
/// \return empty if nothing is given and the fragment has no such facet
/// \source papaioannou 2002, section 6.2
std::vector<CandidateDirection> candidate_directions(const Fragment& fragment,
                                                     const std::vector<glm::dvec3>& given,
                                                     const std::vector<int>& named, int most);

/// The facet whose mean normal is nearest to `direction`, fracture facets first; -1 if there is none.
int facet_towards(const Fragment& fragment, const glm::dvec3& direction);

}  // namespace rejoin::match
