/// From which side a surface can be seen.
#pragma once

#include "mesh/mesh.hpp"
#include "mesh/ray_scene.hpp"

namespace rejoin::mesh::detail {

/// Shares of the rays from all over a surface that leave it without meeting it again.
struct Outlook {
  double front = 0;  ///< of those that start on the side to which faces and normals point
  double back = 0;   ///< of those from the other side
};

/// Looks out from some 500 places of the surface in 16 directions each.  Deterministic.  Holes, several parts and unconnected
/// faces change the shares only by what can be seen through the gaps.
/// \pre the mesh has faces, and an area
Outlook outlook(const Mesh& mesh);

/// The same of a part of a surface, with all of it in the way.
/// \param whole  of the surface
/// \param size   its diameter
Outlook outlook(const Mesh& part, const RayScene& whole, double size);

/// Whether the surface is inside out: next to nothing can be seen from its front, all that can be seen is its back.  No scanner
/// records such a surface; one that was scanned from one side alone, whatever its shape, is not taken for it.
bool is_inside_out(const Outlook& outlook);

}  // namespace rejoin::mesh::detail
