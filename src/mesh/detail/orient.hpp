/// Winding of faces.
#pragma once

#include <cstddef>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

struct Turned {
  std::size_t inconsistent = 0;  ///< faces turned to agree with their neighbours
  bool inside_out = false;       ///< all faces were turned
  std::size_t of_parts = 0;      ///< faces of parts, not connected with the rest, that were turned after that
};

/// Winds faces as their neighbours across two-faced edges (of every connected part the larger area stays),
/// then turns a surface outwards: a closed one if it encloses a negative volume, an open one if next to nothing of its front can
/// be seen (outlook.hpp), and so each of several parts that hang together in no vertex.  A surface that cannot be wound
/// consistently (a Moebius strip) stays as it is.
/// \pre the mesh has an area
Turned orient_faces(Mesh& mesh);

}  // namespace rejoin::mesh::detail
