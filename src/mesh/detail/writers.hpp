/// Writers of mesh formats into memory.
#pragma once

#include <string>
#include <vector>

#include "mesh/detail/soup.hpp"
#include "mesh/save.hpp"

namespace rejoin::mesh::detail {

/// Whether coordinates are so far from the origin, against the size of what they describe, that floats would
/// lose detail of it.
bool is_far(const Soup& soup);

// The soup holds triangles only.
std::string write_ply(const Soup& soup);
std::string write_obj(const Soup& soup);

/// Empty if they take more than the 4 GiB that a GLB file holds.
std::string write_glb(const std::vector<Placed>& parts);

}  // namespace rejoin::mesh::detail
