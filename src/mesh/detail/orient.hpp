/// Winding of faces.
#pragma once

#include <cstddef>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

struct Turned {
  std::size_t inconsistent = 0;  ///< faces turned to agree with their neighbours
  bool inside_out = false;  ///< all faces were turned, because the closed surface enclosed a negative volume
};

/// Winds faces as their neighbours across two-faced edges (of every connected part the larger area stays),
/// then turns a closed surface outwards.  A surface that cannot be wound consistently (a Moebius strip) stays
/// as it is.
Turned orient_faces(Mesh& mesh);

}  // namespace rejoin::mesh::detail
