/// Where two closed sequences agree for a while: the longest common subsequence with a price for what is left out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "outline/common_subsequence.hpp"
#include "outline/detail/turn_model.hpp"

namespace rejoin::outline::detail {

struct LocalOptions {
  int skip = 32;          ///< price of leaving out a value, in the model's units
  int least = 60;         ///< alignments below this score are none
  std::size_t most = 30;  ///< alignments in all
};

/// A stretch of a along a stretch of b.
struct LocalMatch {
  Pairing
      pairs;  ///< positions in a and b, cyclic, in the order along the stretch; only those that speak for the stretch
  int score = 0;  ///< sum of the model's scores less the skips
};

/// The best alignments of different places, best first.  Smith and Waterman's recurrence; a.size() * b.size() * 2.25 steps.
/// \param a, b  levels of the model
/// \pre a and b have at most 40000 values
std::vector<LocalMatch> local_alignments(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                                         const TurnModel& model, const LocalOptions& options);

}  // namespace rejoin::outline::detail
