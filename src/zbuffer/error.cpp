#include "zbuffer/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "zbuffer/detail/pair_score.hpp"

namespace rejoin::zbuffer {
namespace {

std::string shape_of(const DepthMap& map) {
  return std::to_string(map.width) + " x " + std::to_string(map.height);
}

void require_same_shape(const DepthMap& a, const DepthMap& b) {
  if (a.width != b.width || a.height != b.height) {
    throw InputError("depth maps", "shapes differ, " + shape_of(a) + " and " + shape_of(b));
  }
}

}  // namespace

PairScore slope_difference(const DepthMap& a, const DepthMap& b, double view_side) {
  require_same_shape(a, b);
  return detail::pair_score(detail::slope_sums(a.depth.data(), b.depth.data(), a.width, a.height), view_side);
}

DepthMap slope_difference_map(const DepthMap& a, const DepthMap& b, double view_side) {
  require_same_shape(a, b);
  DepthMap slopes(a.width, a.height);
  const auto pixels_per_unit = static_cast<float>(a.width / view_side);
  for (int j = 0; j + 1 < a.height; ++j) {
    for (int i = 0; i + 1 < a.width; ++i) {
      const int m = a.width - 1 - i;
      const float u = a.at(i + 1, j) - a.at(i, j) + b.at(m - 1, j) - b.at(m, j);
      const float v = a.at(i, j + 1) - a.at(i, j) + b.at(m, j + 1) - b.at(m, j);
      const float slope = (std::abs(u) + std::abs(v)) * pixels_per_unit;
      slopes.at(i, j) = std::isfinite(slope) ? slope : kBackground;
    }
  }
  return slopes;
}

double overlap_bias(const PairScore& score) {
  if (score.overlap == 0) return std::numeric_limits<double>::infinity();
  return static_cast<double>(std::min(score.covered_a, score.covered_b)) / score.overlap;
}

}  // namespace rejoin::zbuffer
