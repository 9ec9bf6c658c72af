/// What else than one piece a scan may hold.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Shares of the area of the bodies that lie side by side: of the parts (faces that share vertices) with at least a twentieth of the
/// area, but for flat sheets, those between which a plane passes with some room.  Parts that enclose each other, and sides of one
/// sherd that turn their backs to each other, are one body.
/// \return largest first; fewer than two for the scan of one piece
/// \pre the mesh has faces, which face outwards
std::vector<double> bodies(const Mesh& mesh);

/// The share of the area that is one plane on which the rest stands and that reaches beyond the rest on every side, as a table does, or
/// a plane that hangs together with nothing else and has more than 0.3 of it; 0 if there is none.  A piece's flat underside has the piece behind it, and a plate's floor ends at its rim.
/// \pre as of bodies()
double table(const Mesh& mesh);

}  // namespace rejoin::mesh
