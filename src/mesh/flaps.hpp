/// Flaps of a table or of cloth that hang on a scan.
#pragma once

#include <optional>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

struct Flaps {
  std::optional<Mesh> rest;  ///< the scan without those that are cut off; nullopt: none is
  double share = 0;          ///< of the area, in these
  double doubtful = 0;       ///< of the area, in others, which may be a part of the piece
};

/// Cuts off flaps: thin sheets beside a piece, as scans bring along of what it lay on.
///
/// A flap has a hundredth of the area or more.  Either it is open, with no body on either side, and half of its border or more is
/// where the scan ends; or it is a leaf, no thicker than a fifth of the piece's median thickness, six times as wide as thick, which
/// hangs on what is three times as thick at once and has the piece on one side of its plane.  It is cut off only where this leaves no
/// hole: rays do not leave the body through it, and the body beside the seam is closed without it.  So pieces of which a side was not
/// scanned keep all that they have, and edges that run out, rims, ribs and fins stay.  A leaf more than three edges thick may have
/// breaks that can be joined: it is doubtful.  Not found are leaves that are most of the area.  Deterministic; nothing depends on units.
/// \pre the mesh has faces
Flaps cut_off_flaps(const Mesh& mesh);

}  // namespace rejoin::mesh
