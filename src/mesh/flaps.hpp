/// Flaps of a table or of cloth that hang on a scan.
#pragma once

#include <optional>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// A scan without its flaps.
struct Trimmed {
  Mesh surface;
  double share = 0;  ///< of the area, in flaps
};

/// Cuts off flaps: thin sheets beside a piece, as scans bring along of what the piece lay on.
///
/// A flap is a part with a hundredth of the area or more that is open, with nothing behind it on either side, and ends freely along
/// half of its border or more; or a leaf, with a back no farther than a fifth of the piece's thickness from its front, which hangs on
/// what is three times as thick at once, is wide against its thickness and leaves the piece on one side of it.  It is cut off only if
/// the piece is closed without it: it is no wall of the body, nor is the surface beside it open then.  So a piece of which a side was
/// not scanned keeps all that it has, and edges that run out, rims and ribs stay.  Deterministic; lengths count against each other only.
/// \return nothing if there are none
/// \pre the mesh has faces
std::optional<Trimmed> without_flaps(const Mesh& mesh);

}  // namespace rejoin::mesh
