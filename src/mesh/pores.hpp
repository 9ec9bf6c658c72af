/// Pores of spongy bone, bubbles of stone and clay.
#pragma once

#include <optional>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// What of a porous piece lies open.
struct Open {
  Mesh surface;      ///< without the faces in pores
  double share = 0;  ///< of the area, in pores
};

/// Leaves out what lies in pores, where nothing can touch it: faces from whose front most directions end at another face near by.
///
/// A piece is porous if a tenth of its area or more lies deep in something, and if that has many mouths: a vessel's inside,
/// a canal of a long bone and a fold of a figure have few. Where most of every deep place shows along one direction, another one for each, it is the relief of a
/// splintery break.
/// \param size  diameter of the piece, mesh units: pores are small against it
/// \return nothing if the piece is not porous, or hardly anything of it would be left
/// \pre the mesh has faces
std::optional<Open> without_pores(const Mesh& mesh, double size);

}  // namespace rejoin::mesh
