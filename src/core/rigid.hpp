/// Proper rigid motions in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace rejoin {

/// x -> rotation * x + translation.  rotation is orthonormal with determinant +1.
struct Rigid {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};

  glm::dvec3 operator()(const glm::dvec3& point) const { return rotation * point + translation; }
};

/// first apply b, then a.
inline Rigid operator*(const Rigid& a, const Rigid& b) {
  return {a.rotation * b.rotation, a.rotation * b.translation + a.translation};
}

inline Rigid inverse(const Rigid& a) {
  const glm::dmat3 back = glm::transpose(a.rotation);
  return {back, -(back * a.translation)};
}

/// Angle of the rotation that takes a's orientation to b's, radians in 0 .. pi.
inline double angle_between(const Rigid& a, const Rigid& b) {
  const glm::dmat3 r = glm::transpose(a.rotation) * b.rotation;
  return std::acos(std::clamp((r[0][0] + r[1][1] + r[2][2] - 1.0) / 2.0, -1.0, 1.0));
}

/// Whether columns are unit vectors at right angles to 1e-4, right-handed; not for a NaN.
bool is_rotation(const glm::dmat3& matrix);

/// Rotation by `angle_rad` about the unit vector `axis` (Rodrigues).
inline glm::dmat3 axis_rotation(const glm::dvec3& axis, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  const glm::dmat3 cross(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
  return glm::dmat3(c) + s * cross + (1.0 - c) * glm::outerProduct(axis, axis);
}

/// The shortest rotation that takes unit vector `from` to unit vector `to`; opposite vectors give a half turn
/// about some axis perpendicular to them.
glm::dmat3 rotation_between(const glm::dvec3& from, const glm::dvec3& to);

/// Two unit vectors that complete the unit vector z to a right-handed orthonormal frame: columns (x, y, z).
glm::dmat3 frame_of(const glm::dvec3& z);

}  // namespace rejoin
