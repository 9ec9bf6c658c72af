/// Puts the pieces of flat objects together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "outline/matcher.hpp"

namespace rejoin::outline {

struct AssemblyOptions {
  std::vector<double> samples = {640.0, 240.0,
                                 100.0};  ///< steps of a border of median length, a number for each
                                          ///< scale; the one that fits the joins best is used
  double least_strength =
      8.0;  ///< that joins a group to another, nats: evidence of the candidates that agree, as odds
            ///< by their scores, and 0.3 of the contacts' information
  Matcher* second =
      nullptr;  ///< looks at each piece without a place by the first with all others; need not be prepared.
                ///< What it finds is used if the joins become longer together
  double most_intrusion = 0.3;  ///< border deep inside another piece, share of the contact's length
};

/// Where a piece lies.
struct Placement {
  Planar pose;              ///< file coordinates -> the group's frame; identity if the piece is alone
  std::size_t group = 0;    ///< the same for pieces of one object; groups are numbered by size, largest first
  double confidence = 0.0;  ///< 0..1, that one of its joins is true, by their scores; 0: placed nowhere
};

/// A piece that fits another one, where it does not lie.  Where it would take the place of a piece that is joined there: that one's rival.
struct AssemblyRival {
  std::size_t piece = 0;
  std::size_t at =
      0;  ///< of a rival: one of the two that are joined, or, if they fit each other in two ways, each in turn
  double score = 0.0;  ///< 0..1, of piece and `at` by the search for pairs
};

/// Two placed pieces that share border.
struct AssemblyJoin {
  std::size_t a = 0;
  std::size_t b = 0;
  double score =
      0.0;  ///< 0..1, what the search for pairs gave the join that lies here, less for rivals; 0 if it proposed none
  double contact = 0.0;  ///< length of the shared border, file units; see shared_borders()
  bool proposed =
      false;  ///< by the search for pairs; if not, the pieces lie side by side because of other joins
  std::vector<AssemblyRival> rivals;  ///< best first
};

/// A piece without a place, or in another object than the first, whose outline a piece has too that is placed before it, see congruent():
/// mostly a second scan of it, or one of its other side.
struct AssemblyRepeat {
  std::size_t piece = 0;
  std::size_t of = 0;  ///< one in an earlier object or, of two without a place, that comes before it
  bool turned_over = false;
};

struct Assembly {
  std::vector<Placement> placements;  ///< one a piece
  std::vector<AssemblyJoin> joins;    ///< all that share more than a corner, best first
  std::vector<AssemblyJoin> touches;  ///< those that share less
  std::vector<std::size_t> unplaced;  ///< pieces that fit nowhere
  std::vector<std::size_t>
      untried;  ///< pieces without a place whose pairs were not all looked at; see cancelled
  std::vector<AssemblyRepeat> repeats;  ///< ascending by piece
  std::vector<AssemblyRival>
      refused;  ///< of unplaced pieces that have a sure candidate, the best: laid there they would overlap
                ///< others or only touch them, or it is not sure enough alone; none if joining was cancelled
  std::vector<std::vector<double>>
      similarity;    ///< length of the common border of each pair's best candidate, used or not; 0 if none
  double rms = 0.0;  ///< distance of the borders along all joins, file units
  bool cancelled = false;  ///< not all pairs were looked at
};

/// Matches all pairs and joins them greedily, the most telling first.  When two groups become one, what their pieces
/// have in common with a third adds up (the similarity matrix is merged).  A merge that makes pieces overlap or leaves
/// a loop open is refused; pieces that stand in the way of a better join are taken off again.  At the end the error is
/// spread over all joins by least squares.  Congruent pieces are not matched with each other.  Then, perhaps, all that once
/// more with the candidates of a second search for what has no place.
/// \param matcher  prepared with these pieces
/// \return for a context that is cancelled while pairs are matched: what those matched so far give, all joined, which
///         nothing but the end of the process stops; pieces that might fit where nobody looked are
///         `untried`, not `unplaced`
/// \source zhang 2016, section 4.4
Assembly assemble(const std::vector<Piece>& pieces, const Matcher& matcher, const AssemblyOptions& options,
                  const Context& context);

/// The second part of assemble(): from matched pairs.
/// \param pairs  results for (0, 1), (0, 2) .. (0, n - 1), (1, 2) ..
Assembly assemble(const std::vector<Piece>& pieces, const std::vector<PairResult>& pairs,
                  const AssemblyOptions& options, const Context& context);

}  // namespace rejoin::outline
