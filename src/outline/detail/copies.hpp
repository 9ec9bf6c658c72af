/// Pieces that are there twice: scanned again, or from the other side.
#pragma once

#include <vector>

#include "outline/assembly.hpp"
#include "outline/detail/links.hpp"

namespace rejoin::outline::detail {

/// Of the pieces without a place, and of those in any object but the first, the ones whose outline a piece has, turned over or not, that is
/// placed in an earlier object or, of two without a place, comes first; ascending.
/// \param alike  pairs that are congruent()
std::vector<AssemblyRepeat> repeats_of(const std::vector<Piece>& pieces, const Assembly& assembly,
                                       const NamesOfPairs& alike);

}  // namespace rejoin::outline::detail
