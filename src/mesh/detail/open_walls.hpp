/// Walls of sherds that were scanned from one side.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/detail/grow.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// What the facets of an open surface tell.
struct OpenWalls {
  /// Per sample: on a wide facet, cut by a cone and along creases.  Narrow ones are breaks, rims or ridges.
  std::vector<bool> wall;
  /// What the narrow facets at the end of the scan measure across, mesh units; 0 unless the surface is a sherd's: it ends at such
  /// for the greater part, is no more bent than a wall, and its wide facets hardly meet at creases, as those of a solid piece do.
  double break_width = 0;
};

/// \param ground  all samples, in one class
/// \param smallest  samples of a facet, at least
/// \param wide  facets that measure more across are walls, mesh units
OpenWalls open_walls(const Mesh& mesh, const Ground& ground, std::size_t smallest, double wide);

}  // namespace rejoin::mesh::detail
