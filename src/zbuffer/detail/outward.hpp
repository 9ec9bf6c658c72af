/// Which faces of a mesh can only be seen from their front.
#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::zbuffer::detail {

/// True for the faces of closed components (each edge has two faces, wound the same way) that enclose a positive volume.
/// Whoever looks from outside meets such a component from its front first, so faces that look away hide nothing.  Where a
/// component passes through itself, places that it encloses inside out are an exception.
/// \param faces  of the mesh, their corners finite
std::vector<bool> seen_from_front(const mesh::Mesh& mesh, std::span<const glm::uvec3> faces);

}  // namespace rejoin::zbuffer::detail
