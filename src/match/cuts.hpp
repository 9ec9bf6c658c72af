/// The facets of both cuts of a fragment (mesh::Segmentation) under one numbering.
#pragma once

#include <vector>

#include "match/match.hpp"

namespace rejoin::match {

/// Numbers of the facets: of those that a user sees, then, from `creased` on, of those between creases.
struct FacetNumbers {
  int creased = 0;  ///< the first facet between creases
  int end = 0;
};

FacetNumbers facet_numbers(const Fragment& fragment);

const mesh::Facet& facet(const Fragment& fragment, int number);

/// The facet that a user sees where most of this one lies; -1 if there is none, or for -1.
int seen_facet(const Fragment& fragment, int number);

/// The facets that a user sees, and those between creases that mostly lie in them.
std::vector<int> in_both_cuts(const Fragment& fragment, std::vector<int> seen);

}  // namespace rejoin::match
