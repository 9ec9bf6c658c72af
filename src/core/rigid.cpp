#include "core/rigid.hpp"

namespace rejoin {

bool is_rotation(const glm::dmat3& matrix) {
  constexpr double kTolerance = 1e-4;
  const glm::dmat3 product = glm::transpose(matrix) * matrix;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (!(std::abs(product[column][row] - (row == column ? 1.0 : 0.0)) <= kTolerance)) return false;
    }
  }
  return glm::determinant(matrix) > 0.0;
}

glm::dmat3 frame_of(const glm::dvec3& z) {
  const glm::dvec3 helper = std::abs(z.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, z));
  return {x, glm::cross(z, x), z};
}

glm::dmat3 rotation_between(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double sine = glm::length(axis);
  const double cosine = glm::dot(from, to);
  if (sine < 1e-12)
    return cosine > 0 ? glm::dmat3(1.0) : axis_rotation(frame_of(from)[0], 3.14159265358979323846);
  return axis_rotation(axis / sine, std::atan2(sine, cosine));
}

}  // namespace rejoin
