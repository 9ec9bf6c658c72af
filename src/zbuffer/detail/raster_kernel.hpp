/// Many small triangles into a depth map.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "zbuffer/detail/canvas.hpp"
#include "zbuffer/detail/view.hpp"

namespace rejoin::zbuffer::detail {

/// Triangles a block; a vector of any processor takes a whole fraction of it.
inline constexpr std::size_t kSoupBlock = 16;

/// A mesh's triangles without indices, corner by corner, so that vectors of triangles load without gathering.
///
/// A block of 16 triangles is 9 x 16 floats: x of all first corners, y, z, x of all second corners, ...  Blocks of
/// triangles that can only be seen from their front come first.  The last block of both kinds is filled up with triangles of
/// no area; faces with a corner that is not finite are left out.
struct TriangleSoup {
  /// All normals of a block's triangles lie within an angle of the axis.
  struct Cone {
    glm::vec3 axis{0.0F};
    float sine = 2.0F;  ///< of that angle; 2: the cone says nothing
  };

  std::vector<float> blocks;
  std::vector<Cone> cones;  ///< of the blocks that can only be seen from the front
  mesh::Box box;            ///< of all corners

  std::size_t block_count() const { return blocks.size() / (9 * kSoupBlock); }
};

TriangleSoup soup_of(const mesh::Mesh& mesh);

/// Draws all triangles but those that only their front can be seen of and that look away; nearest depth wins.  Covers
/// exactly what draw() covers, with the exception of sided_faces(); depths differ by rounding only.  The same bits on every processor.
void draw_soup(const TriangleSoup& soup, const Projection& projection, const Canvas& canvas);

/// Name of the instructions that draw_soup uses here: "AVX3", "NEON", ...
std::string instruction_set();

}  // namespace rejoin::zbuffer::detail
