/// From sums to the score that callers see.
#pragma once

#include "zbuffer/detail/slope_sums.hpp"
#include "zbuffer/error.hpp"

namespace rejoin::zbuffer::detail {

/// \param view_side  f_R, mesh units
inline PairScore pair_score(const SlopeSums& sums, double view_side) {
  PairScore score;
  score.overlap = sums.overlap;
  score.covered_a = sums.covered_a;
  score.covered_b = sums.covered_b;
  if (sums.overlap > 0) score.error = static_cast<float>(sums.sum / (sums.overlap * view_side));
  return score;
}

}  // namespace rejoin::zbuffer::detail
