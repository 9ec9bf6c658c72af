/// Holes of a scan that software has closed.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Faces by which scanning software closed holes, where nothing was seen: patches of 30 vertices or more that are far smoother than the
/// scanner's noise lets anything be.  Only in scans whose noise is_of_scanner(); narrow strips are not found.
/// \return ascending   \pre the mesh has faces
std::vector<std::uint32_t> filled_holes(const Mesh& mesh);

}  // namespace rejoin::mesh
