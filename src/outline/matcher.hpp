/// What all methods for flat pieces have in common.
#pragma once

#include <cstddef>
#include <vector>

#include "core/context.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline {

/// A way to find how two outlines join.
class Matcher {
 public:
  virtual ~Matcher() = default;

  /// Computes what each piece needs once; called before match(), and again when the pieces change.
  /// \param pieces  outlines in one unit
  /// \throws InputError a piece cannot be used; the message names it
  virtual void prepare(const std::vector<Piece>& pieces) = 0;

  /// How pieces a and b of the last prepare() join.  Thread-safe; the same answer for any number of threads.  Returns
  /// what it has when the context is cancelled.
  /// \pre a != b, both below the number of pieces
  virtual PairResult match(std::size_t a, std::size_t b, const Context& context) const = 0;
};

/// What a search says of two pieces that takes the one with the shorter border first, so that the answer is the same for B and A.
/// \param search  (first, second) -> PairResult
template <typename Search>
PairResult shorter_first(std::size_t a, std::size_t b, const std::vector<double>& perimeters,
                         const Search& search) {
  if (perimeters[a] <= perimeters[b]) return search(a, b);
  PairResult result = search(b, a);
  for (JoinCandidate& candidate : result.candidates)
    candidate = exchanged(candidate, perimeters[b], perimeters[a]);
  return result;
}

}  // namespace rejoin::outline
