#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "zbuffer/detail/drawable.hpp"
#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer::detail {
namespace {

constexpr float kCells = 1023.0F;  ///< a side of the box, in steps of 10 bits

/// The lowest 10 bits of x, with two free bits before each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 16U)) & 0x030000FFU;
  x = (x | (x << 8U)) & 0x0300F00FU;
  x = (x | (x << 4U)) & 0x030C30C3U;
  return (x | (x << 2U)) & 0x09249249U;
}

/// Puts neighbours together (Morton order of the centres).  Triangles that lie close are mostly of one size
/// and one direction, so those that are drawn in step cover boxes of about the same number of pixels, and
/// none waits long for the others; a mesh in random order takes half as long again.
void sort_by_place(std::vector<glm::uvec3>& faces, const mesh::Mesh& mesh, const mesh::Box& box) {
  const glm::vec3 extent = box.high - box.low;
  const float longest = std::max({extent.x, extent.y, extent.z, std::numeric_limits<float>::min()});
  std::vector<std::pair<std::uint32_t, glm::uvec3>> keyed;
  keyed.reserve(faces.size());
  for (const glm::uvec3& f : faces) {
    const glm::vec3 centre = (mesh.vertices[f.x] - box.low) / 3.0F + (mesh.vertices[f.y] - box.low) / 3.0F +
                             (mesh.vertices[f.z] - box.low) / 3.0F;
    const glm::uvec3 cell(glm::clamp(centre / longest, 0.0F, 1.0F) * kCells);
    keyed.emplace_back(spread(cell.x) | (spread(cell.y) << 1U) | (spread(cell.z) << 2U), f);
  }
  std::ranges::stable_sort(keyed, {}, &std::pair<std::uint32_t, glm::uvec3>::first);
  std::ranges::transform(keyed, faces.begin(), &std::pair<std::uint32_t, glm::uvec3>::second);
}

void put(TriangleSoup& soup, std::size_t place, std::size_t corner, const glm::vec3& v) {
  float* block = soup.blocks.data() + place / kSoupBlock * 9 * kSoupBlock;
  for (int axis = 0; axis < 3; ++axis) {
    block[(3 * corner + static_cast<std::size_t>(axis)) * kSoupBlock + place % kSoupBlock] = v[axis];
  }
}

}  // namespace

TriangleSoup soup_of(const mesh::Mesh& mesh) {
  std::vector<glm::uvec3> faces = finite_faces(mesh);
  TriangleSoup soup;
  if (faces.empty()) return soup;
  soup.box = box_of(mesh, faces);
  sort_by_place(faces, mesh, soup.box);
  const glm::uvec3 filler(faces.back().x);
  faces.resize((faces.size() + kSoupBlock - 1) / kSoupBlock * kSoupBlock, filler);
  soup.blocks.resize(9 * faces.size());
  for (std::size_t place = 0; place < faces.size(); ++place) {
    for (int corner = 0; corner < 3; ++corner) {
      put(soup, place, static_cast<std::size_t>(corner), mesh.vertices[faces[place][corner]]);
    }
  }
  return soup;
}

}  // namespace rejoin::zbuffer::detail
