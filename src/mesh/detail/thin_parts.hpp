/// Parts of a surface under which there is little or no body.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// Faces that hang together across edges.
struct ThinPart {
  std::vector<std::uint32_t> faces;  ///< ascending
  double area = 0;                   ///< squared mesh units
  double free = 0;                   ///< length of its edges that no other face has, mesh units
  double attached = 0;               ///< of those where it meets the rest
  std::vector<glm::uvec2> seam;      ///< the latter: their ends, vertices of the mesh
};

/// \param thin  of each face; single faces follow their surroundings, and small islands what lies around them
/// \param least  area of a part that is told, squared mesh units
std::vector<ThinPart> thin_parts(const Mesh& mesh, const std::vector<bool>& thin, double least);

}  // namespace rejoin::mesh::detail
