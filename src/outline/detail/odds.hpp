/// Scores as odds.
#pragma once

#include <cmath>

namespace rejoin::outline::detail {

/// \param log_odds  that a candidate is a join
/// \return the chance of it, 0..1: its score
inline double score_of_odds(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// The inverse of score_of_odds().  \pre the score lies between 0 and 1
inline double odds_of_score(double score) {
  return std::log(score) - std::log1p(-score);
}

}  // namespace rejoin::outline::detail
