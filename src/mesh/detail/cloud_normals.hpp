/// Normals of clouds: where there are none, and where they point the wrong way.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/detail/neighbour_lists.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// Unit normals from the neighbourhood of every point (Hoppe et al. 1992), turned to agree with their neighbours' (make_normals_agree()),
/// and every part so that its furthest points in all directions, which are on its outside whatever its shape, have outward normals.
/// \param near  of the points
std::vector<glm::vec3> estimate_normals(const std::vector<glm::vec3>& points, const NeighbourLists& near);

/// What check_normals() did.
enum class NormalsFound {
  Good,       ///< kept
  InsideOut,  ///< all turned
  Mixed,      ///< pointed this way and that: turned to agree
};

/// Turns the normals that a cloud came with where the surface through it can be seen from its front only after that (outlook()).
/// What is scanned from one side is kept as it is.
/// \param neighbours  of the cloud's points
/// \pre unit normals
NormalsFound check_normals(Mesh& cloud, CloudNeighbours& neighbours);

}  // namespace rejoin::mesh::detail
