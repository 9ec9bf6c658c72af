/// The table on which pieces were scanned.
#pragma once

#include <optional>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

inline constexpr double kFacesUp = 0.3;  ///< cosine between the normals of a table and of its faces, at least

/// A plane; its points p have dot(p, up) == height, relative to the mesh's origin.
struct Table {
  glm::dvec3 up{0, 0, 1};  ///< unit, towards what stands on it
  double height = 0;
  double thickness = 0;  ///< how far from the plane its surface lies on either side
  double share = 0;      ///< of the area, or of the points of a cloud
};

struct TableOptions {
  double least_front = 0.05;  ///< of the area, or of the points, that stands on it
  bool beyond = true;         ///< it has to reach beyond the rest on every side
};

/// Finds the plane on which the rest stands: at least a fifth of the area, with hardly anything behind it.  What of it hangs together
/// with the pieces faces them; a piece's flat underside has the piece behind it, and a plate's floor ends at its rim.  A cloud's normals
/// do not matter.  Deterministic.
/// \return nullopt: there is none
/// \pre the mesh has an area, or the cloud points
std::optional<Table> find_table(const Mesh& scan, const TableOptions& options = {});

}  // namespace rejoin::mesh
