/// Triangles around the inside of a field.
#pragma once

#include <functional>

#include "core/context.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::shatter {

/// A field over space, below 0 inside.  It must change by about 1 a unit of length near the surface; called
/// from several threads.
using Field = std::function<double(const glm::dvec3& point)>;

/// Where to look, and how finely.
struct Grid {
  glm::dmat3 axes{1.0};    ///< orthonormal; columns are the grid's axes
  glm::dvec3 centre{0.0};  ///< of the looked-at cube
  double size = 1;         ///< side of the cube, mesh units
  double spacing = 0.01;   ///< of the grid, mesh units
};

/// The surface where the field is 0: one vertex in every cell that it passes through, in the middle of its
/// crossings with the cell's edges; a quad (two triangles) around every crossed edge.
///
/// The surface is closed; its edges are about `spacing` long.  Only the neighbourhood of the surface is
/// looked at, in blocks; parts smaller than a block (4 cells) may be missed.  Deterministic for any number of
/// threads.  Cancelled: an empty mesh.
/// \source Gibson 1998, constrained elastic surface nets, without the relaxation
mesh::Mesh surface_nets(const Field& field, const Grid& grid, const Context& context);

}  // namespace rejoin::shatter
