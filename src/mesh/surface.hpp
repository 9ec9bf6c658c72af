/// From clouds to triangles, and to fewer triangles.
#pragma once

#include <cstddef>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// A triangle mesh through the points of an oriented cloud.
///
/// Every point's neighbours are turned down to its tangent plane and triangulated (Delaunay); triangles are
/// taken, those that most neighbourhoods agree on first, as long as the surface stays manifold and
/// consistently wound, then small gaps are closed.  Vertices, their order, normals and colours stay; points
/// that fit nowhere stay without a face.  Sharp edges are covered (normals up to 110 degrees apart); holes
/// wider than about five point spacings stay open; opposite sides of a thin wall are never connected.
/// Deterministic, whatever the number of threads.
///
/// \pre cloud.is_cloud() with normals
Mesh surface_of_cloud(const Mesh& cloud);

/// Gives a cloud without normals those that load() would estimate.
void estimate_normals(Mesh& cloud);

/// A mesh of about `face_budget` faces (never more than the input's) for depth maps; the error stays small
/// against a pixel at the resolutions that budget is meant for.  Falls back to vertex clustering where the
/// topology stops the quadric simplifier.
///
/// \pre the mesh has faces
Mesh simplify(const Mesh& mesh, std::size_t face_budget);

}  // namespace rejoin::mesh
