#include "mesh/detail/directions.hpp"

#include <cmath>
#include <numbers>

namespace rejoin::mesh::detail {

std::vector<glm::vec3> half_sphere_directions(std::size_t count) {
  std::vector<glm::vec3> directions;
  directions.reserve(count);
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<double>(k);
    const double z = (i + 0.5) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(turn * i), r * std::sin(turn * i), z);
  }
  return directions;
}

glm::mat3 frame_about(const glm::vec3& axis) {
  const glm::vec3 across =
      glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.6F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  return {across, glm::cross(axis, across), axis};
}

}  // namespace rejoin::mesh::detail
