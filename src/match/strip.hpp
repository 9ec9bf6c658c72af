/// Narrow fracture facets, as sherds have.
#pragma once

#include <vector>

#include "match/relief.hpp"

namespace rejoin::match {

/// Sets `across` from the other fields: area over length; if that makes the patch a strip, or it runs all around its middle, the area within a disc around one of its
/// points, over the disc's diameter, the median of 32 such, as the chord of a bent strip is shorter than the strip.
void measure_across(FacetPatch& patch);

/// Whether both facets are so much longer than wide that they can join along each other only.
bool are_strips(const FacetPatch& a, const FacetPatch& b);

/// Turns of b's patch against a's, 0 to 2 pi, at which some stretch of one strip lies along one of the other that is bent alike.  A break
/// around a vessel is an arc, of which another sherd may have any part.  All turns, if either runs all around as a tube's break.
/// \param step  between neighbouring turns, radians
std::vector<double> turns_along(const FacetPatch& a, const FacetPatch& b, double step);

}  // namespace rejoin::match
