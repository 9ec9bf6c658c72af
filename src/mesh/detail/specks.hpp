/// Dust, stray faces and points that a scanner leaves far from the piece.
#pragma once

#include <cstddef>

#include "mesh/detail/neighbour_lists.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

struct Specks {
  std::size_t parts = 0;
  std::size_t faces = 0;
};

/// Drops parts of the surface (faces that share vertices) that are small and lie clearly apart: each has less than 1 % of the
/// area, and its box is farther from the box of all that is kept than a tenth of the diagonal of the larger parts' box.  What has
/// no larger part, and patches near each other, stay; but what has less than a 2000th of the area and floats, two edges of a mean
/// triangle and more off the surface of what is larger, goes too, where all such parts have less than a twentieth together.  Call drop_unused_vertices() after it.
/// \pre no face is degenerate
Specks drop_specks(Mesh& mesh);

struct Spikes {
  std::size_t vertices = 0;
  std::size_t faces = 0;
};

/// Drops vertices that lie farther from the box of most vertices than four times its diagonal, with their faces: values that
/// were stored wrong.  All vertices stay where such ones are more than one in a thousand, which is a shape.
Spikes drop_spikes(Mesh& mesh);

/// Drops the points of a cloud that belong to no surface: strays (cloud_parts.hpp), and small groups far from the rest as
/// drop_specks() does (less than 1 % of the points).
/// \param near  of the cloud's points
/// \return how many
std::size_t drop_stray_points(Mesh& cloud, const NeighbourLists& near);

}  // namespace rejoin::mesh::detail
