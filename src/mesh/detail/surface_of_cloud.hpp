/// A surface through a cloud whose neighbours are known.
#pragma once

#include "mesh/detail/neighbour_lists.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// The same as rejoin::mesh::surface_of_cloud().
/// \param neighbours  of the cloud's points
Mesh surface_of_cloud(const Mesh& cloud, CloudNeighbours& neighbours);

}  // namespace rejoin::mesh::detail
