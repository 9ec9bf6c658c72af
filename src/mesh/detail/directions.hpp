/// Directions spread evenly.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace rejoin::mesh::detail {

/// Unit vectors spread over the half sphere about z (golden spiral, after a Fibonacci lattice).
std::vector<glm::vec3> half_sphere_directions(std::size_t count);

/// A frame with its z along a unit vector.
glm::mat3 frame_about(const glm::vec3& axis);

}  // namespace rejoin::mesh::detail
