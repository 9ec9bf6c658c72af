/// Which parts of a surface are bodies of their own.
#pragma once

#include <vector>

#include "mesh/detail/parts.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// A part that may be a body, or a side of one.
struct Block {
  Part part;
  Mesh mesh;  ///< the part alone
};

/// Of every two blocks, whether they are two bodies.  Symmetrical.
using Apart = std::vector<std::vector<bool>>;

/// By planes that pass between two blocks with some room.  Blocks that enclose each other, and sides of one sherd that turn their backs
/// to each other, are not apart.
Apart apart_by_planes(const std::vector<Block>& blocks);

/// Whether both blocks are closed surfaces of which neither lies in the other.
bool are_two_closed(const Block& a, const Block& b);

}  // namespace rejoin::mesh::detail
