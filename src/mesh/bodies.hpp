/// What else than one piece a scan may hold.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Shares of the area of the bodies: of the parts (faces that share vertices) with at least a twentieth of the area, but for flat
/// sheets, those between which a plane passes with some room, and closed ones that touch or cross.  Parts that enclose each other, and
/// sides of one sherd that turn their backs to each other, are one body.
/// \return largest first; fewer than two for the scan of one piece
/// \pre the mesh has faces, which face outwards
std::vector<double> bodies(const Mesh& mesh);

}  // namespace rejoin::mesh
