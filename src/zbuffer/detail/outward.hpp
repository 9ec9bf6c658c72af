/// Which faces of a mesh need not be drawn where they look away.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::zbuffer::detail {

/// The faces whose corners are finite, each kind in the order of the mesh.
struct SidedFaces {
  /// Of closed components (each edge has two faces, wound the same way) that enclose a positive volume.  Whoever looks from
  /// outside meets such a component from its front first, so faces that look away hide nothing.  Where a component passes
  /// through itself, places that it encloses inside out are an exception.
  std::vector<glm::uvec3> front_only;
  std::vector<glm::uvec3> both;  ///< all others
};
SidedFaces sided_faces(const mesh::Mesh& mesh);

}  // namespace rejoin::zbuffer::detail
