#include "zbuffer/detail/slope_sums.hpp"

#include <cmath>
#include <cstddef>

namespace rejoin::zbuffer::detail {

SlopeSums slope_sums_scalar(const float* a, const float* b, int width, int height) {
  SlopeSums sums;
  for (int j = 0; j + 1 < height; ++j) {
    const float* row_a = a + static_cast<std::ptrdiff_t>(j) * width;
    const float* row_b = b + static_cast<std::ptrdiff_t>(j) * width;
    for (int i = 0; i + 1 < width; ++i) {
      const int m = width - 1 - i;
      const double a_u = static_cast<double>(row_a[i + 1]) - row_a[i];
      const double a_v = static_cast<double>(row_a[i + width]) - row_a[i];
      const double b_u = static_cast<double>(row_b[m - 1]) - row_b[m];
      const double b_v = static_cast<double>(row_b[m + width]) - row_b[m];
      const bool in_a = std::isfinite(a_u) && std::isfinite(a_v);
      const bool in_b = std::isfinite(b_u) && std::isfinite(b_v);
      sums.covered_a += in_a ? 1 : 0;
      sums.covered_b += in_b ? 1 : 0;
      if (in_a && in_b) {
        ++sums.overlap;
        sums.sum += std::abs(a_u + b_u) + std::abs(a_v + b_v);
      }
    }
  }
  return sums;
}

SlopeSums slope_sums(const float* a, const float* b, int width, int height) {
  return slope_sums_scalar(a, b, width, height);
}

}  // namespace rejoin::zbuffer::detail
