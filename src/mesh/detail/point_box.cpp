#include "mesh/detail/point_box.hpp"

#include <algorithm>
#include <cstddef>

namespace rejoin::mesh::detail {

PointBox box_of_all(const std::vector<glm::dvec3>& points) {
  PointBox box{points.front(), points.front()};
  for (const glm::dvec3& point : points) box = {glm::min(box.low, point), glm::max(box.high, point)};
  return box;
}

PointBox box_of_most(const std::vector<glm::dvec3>& points) {
  constexpr std::size_t kSampled = 10000;
  constexpr double kOutside = 0.02;
  const std::size_t step = 1 + points.size() / kSampled;
  PointBox box{};
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points[i][axis]);
    const auto cut = static_cast<std::ptrdiff_t>(kOutside * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + cut, values.end());
    box.low[axis] = values[static_cast<std::size_t>(cut)];
    std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
    box.high[axis] = *(values.end() - 1 - cut);
  }
  return box;
}

PointBox box_of_piece(const std::vector<glm::dvec3>& points) {
  const PointBox all = box_of_all(points);
  const PointBox most = box_of_most(points);
  return all.size() > kFar * most.size() ? most : all;
}

}  // namespace rejoin::mesh::detail
