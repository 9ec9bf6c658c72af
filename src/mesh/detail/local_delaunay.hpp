/// Candidate triangles of an oriented cloud from the neighbourhood of every point.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/detail/neighbour_lists.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// A triangle that at least one of its corners has in its own Delaunay star.
struct Candidate {
  glm::uvec3 corners;  ///< counter-clockwise seen from outside
  int votes;           ///< how many of its corners have it, 1 to 3
  float radius;        ///< of the circumscribed circle, mesh units
};

struct Neighbourhoods {
  std::vector<Candidate> candidates;  ///< most votes first, then smallest radius: a fixed order
  std::vector<glm::vec3>
      axes;            ///< per point: mean normal of its neighbourhood, unit, halfway at a sharp edge
  double spacing = 0;  ///< median distance of neighbouring points, mesh units
};

/// Delaunay star of every point in its tangent plane, to which neighbours are turned down at their
/// true distance, so that a sharp edge unrolls.  Neighbours count only if a surface can lead to
/// them: the opposite side of a thin wall does not.
///
/// \param wide  of the cloud's points
/// \pre cloud.is_cloud() with unit normals
/// \source Gopi, Krishnan, Silva 2000, "Surface reconstruction based on lower dimensional localized
///   Delaunay triangulation"
Neighbourhoods local_delaunay(const Mesh& cloud, const NeighbourLists& wide);

}  // namespace rejoin::mesh::detail
