/// Holes of a scan, as scanning software closes them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/random.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::shatter {

/// Replaces round patches by the membranes that their rims span: nothing was seen there.
/// \param open    one a vertex: whether it may lie in a patch
/// \param share   of those vertices that are to lie in patches, 0 to 1
/// \param radius  mesh units, of the largest patch; the smallest has half of it
void close_holes(mesh::Mesh& scan, std::vector<std::uint8_t> open, double share, double radius,
                 Random& random);

}  // namespace rejoin::shatter
