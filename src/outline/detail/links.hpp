/// The joins that an assembly may use.
#pragma once

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "outline/assembly.hpp"
#include "outline/contact.hpp"
#include "outline/layout.hpp"

namespace rejoin::outline::detail {

// Motions that differ by less are one: radians, and share of the moved piece's size.
inline constexpr double kSameTurn = 0.05;
inline constexpr double kSameShift = 0.04;

/// A candidate of a pair that says something.
struct Link {
  std::size_t a;
  std::size_t b;
  Planar pose;            ///< b -> a
  double information;     ///< of the contact, nats
  double length;          ///< of the contact, file units
  double score;           ///< of the candidate, by the search for pairs
  Boundary boundary;      ///< of the candidate: where the two meet
  double evidence = 0.0;  ///< evidence_of() the candidate, less what its rivals take of it
};

/// How many times likelier a join is by a candidate of this score than by one that says nothing, natural logarithm; >= 0.  It adds up
/// over candidates of several pairs that agree.
double evidence_of(double score);

/// Pairs of pieces, (a, b) with a < b.
using NamesOfPairs = std::set<std::pair<std::size_t, std::size_t>>;

/// Pieces and their links at one scale.
struct LinkedPieces {
  double step = 0.0;                                ///< of the scale, file units
  double tolerance = 0.0;                           ///< within which borders touch, file units
  std::vector<Silhouette> shapes;                   ///< one a piece
  std::vector<double> perimeters;                   ///< of the outer borders, one a piece, file units
  std::vector<Link> links;                          ///< sorted by a, then b
  std::vector<std::vector<std::size_t>> likely_of;  ///< for every piece those that may be rivals, indices
  NamesOfPairs alike;                               ///< that are congruent(): mostly two scans of one piece

  bool are_alike(std::size_t a, std::size_t b) const { return alike.count(std::minmax(a, b)) != 0; }
};

/// Measures the candidates of all pairs at that one of options.samples at which the best of them say most.  Those that
/// overlap or say nothing are left out.
/// \param pieces  at least one
/// \param pairs   results for (0, 1), (0, 2) .. (0, n - 1), (1, 2) ..
/// \param alike   pairs that are congruent()
LinkedPieces link_pieces(const std::vector<Piece>& pieces, const std::vector<PairResult>& pairs,
                         const AssemblyOptions& options, NamesOfPairs alike);

/// Adds the candidates of a second search, measured at the same scale and believed less.
/// \return whether there are such
bool add_links(LinkedPieces& linked, const std::vector<PairResult>& pairs, const AssemblyOptions& options);

/// Whether two links of the same pieces lay them in about the same way.
bool agree(const Link& p, const Link& q, const LinkedPieces& pieces);

/// Whether a link's pieces lie about as it says.
bool lies_so(const Link& link, const LinkedPieces& pieces, const Layout& placed);

/// Length of the most telling link of each pair; 0 if there is none.
std::vector<std::vector<double>> similarity(const LinkedPieces& pieces);

}  // namespace rejoin::outline::detail
