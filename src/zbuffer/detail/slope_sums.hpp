/// The inner loop of the matching error.
#pragma once

namespace rejoin::zbuffer::detail {

/// What the loop adds up; the rest is division.
struct SlopeSums {
  double sum = 0;     ///< of |Du d1 + Du d2| + |Dv d1 + Dv d2| over S, mesh units
  int overlap = 0;    ///< N_S
  int covered_a = 0;  ///< pixels of a that are covered with both their forward neighbours
  int covered_b = 0;  ///< likewise of the mirrored b
};

/// \param a, b  width x height depths, row after row; b as rendered, it is mirrored here by its index.
/// Background is
///              any value that is not finite.
/// The additions have one fixed order, whatever the processor: the same bits everywhere.
SlopeSums slope_sums(const float* a, const float* b, int width, int height);

/// The same by the definition, one pixel after the other, in double precision: the reference for tests.
SlopeSums slope_sums_scalar(const float* a, const float* b, int width, int height);

}  // namespace rejoin::zbuffer::detail
