/// Joins that ask for one border.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/detail/links.hpp"

namespace rejoin::outline::detail {

// Links of a lower score are no rivals.
inline constexpr double kLeastRival = 0.3;

/// The links that lie along most of the border that a link lies along, on its a or its b, but lay another piece there or the same one
/// otherwise, and that are no unlikely joins themselves.  At most one of them and the link is true.  Of pieces in holes nothing is told.
/// \param placed  where the pieces lie; what lies as a link says is beside its pieces, and no rival
/// \return the best of each piece, best first
std::vector<AssemblyRival> rivals_of(const Link& link, const LinkedPieces& pieces, const Layout& placed);

/// What the links that ask for a link's border, wherever the pieces lie, take of its evidence: with o the odds that one of them is true,
/// log(1 + o), as at most one of them and the link is.
double odds_taken(const Link& link, const LinkedPieces& pieces);

/// Of pieces without a place, those with a sure candidate, and their best.
/// \param unplaced  ascending
std::vector<AssemblyRival> refused_of(const LinkedPieces& linked, const std::vector<std::size_t>& unplaced);

/// Score of a join whose border others fit, too: with l the log-odds of its score and r those that one of the rivals is true, the
/// lesser of l and (l - r) / 3.  A third, because near-identical breaks agree with each other for one reason, so that less is behind
/// their odds' difference than it says.
/// \param score  0..1, of the join alone
double contested_score(double score, const std::vector<AssemblyRival>& rivals);

}  // namespace rejoin::outline::detail
