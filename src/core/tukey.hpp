/// Tukey's weight, for fits that outliers must not pull.
#pragma once

#include <cmath>

namespace rejoin {

/// Weight of a residual: 1 at 0, nothing from the scale on (Tukey's biweight).
inline double tukey(double residual, double scale) {
  const double r = residual / scale;
  if (std::abs(r) >= 1.0) return 0.0;
  const double k = 1.0 - r * r;
  return k * k;
}

}  // namespace rejoin
