/// Small holes of a growing surface.
#pragma once

#include "mesh/detail/local_delaunay.hpp"
#include "mesh/detail/sheet.hpp"

namespace rejoin::mesh::detail {

/// Closes boundary loops of a few edges, left where neighbouring stars disagree.  Loops around real holes are longer and stay.
void fill_holes(const Mesh& cloud, const Neighbourhoods& around, Sheet& sheet);

}  // namespace rejoin::mesh::detail
