/// Equal vertices to one vertex, equal faces to one face.
#pragma once

#include <vector>

#include "mesh/load.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// Makes one vertex of all vertices at exactly the same place (no tolerance: nothing may depend on the scale),
/// and of one colour if so asked, and adjusts the faces.  The first one's place in the order stays; normals are
/// added up (not unit length any more), the first colour is kept.
void weld(Mesh& mesh, Weld which = Weld::Places);

/// Whether faces hardly share vertices: there are more than 1.5 a face, where a surface has half of one.
bool is_loose(const Mesh& mesh);

/// Makes one vertex of vertices that are no farther apart than a hundredth of the median edge, or linked by such.
void weld_near(Mesh& mesh);

struct Dropped {
  std::size_t degenerate = 0;  ///< two corners the same, or no area
  std::size_t duplicate = 0;   ///< same corners in the same sense as an earlier face
};

/// Drops degenerate and duplicate faces; the order of the rest stays.
Dropped drop_useless_faces(Mesh& mesh);

/// Of a surface most of whose faces are there in both senses, as renderers that show front sides alone want it, drops the later
/// one of both; leaves others alone, where a few such pairs are folds.
/// \return how many
std::size_t drop_backs(Mesh& mesh);

/// Drops vertices that no face uses.  \pre the mesh has faces
void drop_unused_vertices(Mesh& mesh);

}  // namespace rejoin::mesh::detail
