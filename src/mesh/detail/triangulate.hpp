/// Polygons to triangles.
#pragma once

#include <vector>

#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

/// Triangles of all polygons of the soup, ears cut where a polygon is not convex.  Polygons of
/// fewer than three corners give nothing.
///
/// \pre every corner is the index of a finite point
std::vector<glm::uvec3> triangulate(const Soup& soup);

}  // namespace rejoin::mesh::detail
