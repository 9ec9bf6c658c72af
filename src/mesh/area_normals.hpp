/// Directions of a surface at its vertices.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Sums of the adjacent faces' normals, weighted by area, so that the thin triangles of a scan count little; one a vertex, not of
/// unit length.
std::vector<glm::vec3> area_normals(const Mesh& mesh);

}  // namespace rejoin::mesh
