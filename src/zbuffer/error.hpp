/// The matching error of two facing depth maps.
#pragma once

#include <limits>

#include "zbuffer/depth_map.hpp"

namespace rejoin::zbuffer {

/// What one evaluation yields; everything a bias needs is in it.
struct PairScore {
  /// e_d: mean slope difference, depth as a fraction of the view side f_R, per pixel step.  +infinity if
  /// overlap is 0.
  float error = std::numeric_limits<float>::infinity();
  int overlap = 0;  ///< N_S: pixels where both maps and both their forward neighbours are covered
  int covered_a =
      0;  ///< A_S1 in pixels, counted like overlap: the pixel and both its forward neighbours are covered
  int covered_b = 0;  ///< A_S2 likewise
};

/// e_d = 1/N_S * sum over S of |Du d1 + Du d2| + |Dv d1 + Dv d2|, divided by view_side.
/// \param a          depths of fragment 1, mesh units
/// \param b          depths of fragment 2, as rendered (NOT yet mirrored), same shape as a
/// \param view_side  f_R, mesh units
/// \throws InputError if the shapes differ
/// \source papaioannou 2002, eq. (9) and the algorithm at the end of 3.4.  Deviation: eq. (9) as printed
/// crosses u and v;
///         the form at the end of 3.4 is the right one.  Mirror first, then forward differences.
PairScore slope_difference(const DepthMap& a, const DepthMap& b, double view_side);

/// Per pixel |Du d1 + Du d2| + |Dv d1 + Dv d2| as a slope (dimensionless: mesh units of depth per mesh unit
/// across), kBackground outside S, in a's pixel frame.
DepthMap slope_difference_map(const DepthMap& a, const DepthMap& b, double view_side);

/// lambda_d = min(A_S1, A_S2) / A_S >= 1; +infinity without overlap.  \source papaioannou 2002, section 5.1
double overlap_bias(const PairScore& score);

}  // namespace rejoin::zbuffer
