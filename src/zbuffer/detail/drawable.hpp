/// The part of a mesh that can be drawn, and where it lies in a view.
#pragma once

#include <cmath>
#include <vector>

#include "zbuffer/detail/view.hpp"

namespace rejoin::zbuffer::detail {

inline bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The faces without those that have a corner that is not finite.
std::vector<glm::uvec3> finite_faces(const mesh::Mesh& mesh);

/// Box of all corners of the faces; low = high = 0 without faces.
mesh::Box box_of(const mesh::Mesh& mesh, const std::vector<glm::uvec3>& faces);

/// Box of the box's corners after projection: everything inside the first lies inside the second.
mesh::Box projected(const mesh::Box& box, const Projection& projection);

}  // namespace rejoin::zbuffer::detail
