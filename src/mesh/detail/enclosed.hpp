/// Surface inside a piece, as segmented CT scans have it.
#pragma once

#include <cstddef>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

struct Enclosed {
  std::size_t parts = 0;
  std::size_t faces = 0;
};

/// Drops closed parts of the surface (faces that share vertices) that lie inside the largest: cavities, which no other piece can touch.  A part
/// does so if every one of several rays from places all over it crosses the largest part an odd number of times.  Open parts stay, as patches of
/// a vessel's inside that a scanner has seen are.  Call drop_unused_vertices() after it.
/// \pre no face is degenerate
Enclosed drop_enclosed(Mesh& mesh);

}  // namespace rejoin::mesh::detail
