#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "zbuffer/detail/drawable.hpp"
#include "zbuffer/detail/outward.hpp"
#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer::detail {
namespace {

constexpr float kCells = 1023.0F;         ///< a side of the box, in steps of 10 bits
constexpr float kConeRounding = 0.0005F;  ///< by which a cone is wider than its normals, for they are rounded

/// The lowest 10 bits of x, with two free bits before each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 16U)) & 0x030000FFU;
  x = (x | (x << 8U)) & 0x0300F00FU;
  x = (x | (x << 4U)) & 0x030C30C3U;
  return (x | (x << 2U)) & 0x09249249U;
}

glm::vec3 normal_of(const mesh::Mesh& mesh, const glm::uvec3& face) {
  const glm::dvec3 a(mesh.vertices[face.x]);
  const glm::dvec3 normal =
      glm::cross(glm::dvec3(mesh.vertices[face.y]) - a, glm::dvec3(mesh.vertices[face.z]) - a);
  const double length = glm::length(normal);
  return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0F);
}

/// Cells of a side of the cube on which normals that look alike share one.
constexpr float kNormalCells = 4.0F;

/// The same for normals that look alike.
std::uint32_t direction_of(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (size[axis] == 0.0F) return 0;
  const glm::vec2 on_side = glm::vec2(normal[(axis + 1) % 3], normal[(axis + 2) % 3]) / size[axis];
  const glm::uvec2 cell(glm::clamp((on_side + 1.0F) * (kNormalCells / 2), 0.0F, kNormalCells - 1));
  const std::uint32_t side = 2U * static_cast<std::uint32_t>(axis) + (normal[axis] < 0 ? 1U : 0U);
  return (side * 16U + cell.x) * 16U + cell.y;
}

/// Puts neighbours together (Morton order of the centres), and of those that can only be seen from their front the ones that
/// look the same way.  Triangles that lie close are mostly of one size and one direction, so those that are drawn in step
/// cover boxes of about the same number of pixels, and none waits long for the others; a mesh in random order takes half as
/// long again.
void sort_by_place(std::vector<glm::uvec3>& faces, const mesh::Mesh& mesh, const mesh::Box& box,
                   bool by_direction) {
  const glm::vec3 extent = box.high - box.low;
  const float longest = std::max({extent.x, extent.y, extent.z, std::numeric_limits<float>::min()});
  std::vector<std::pair<std::uint64_t, glm::uvec3>> keyed;
  keyed.reserve(faces.size());
  for (const glm::uvec3& f : faces) {
    const glm::vec3 centre = (mesh.vertices[f.x] - box.low) / 3.0F + (mesh.vertices[f.y] - box.low) / 3.0F +
                             (mesh.vertices[f.z] - box.low) / 3.0F;
    const glm::uvec3 cell(glm::clamp(centre / longest, 0.0F, 1.0F) * kCells);
    const std::uint64_t direction = by_direction ? direction_of(normal_of(mesh, f)) : 0U;
    keyed.emplace_back(direction << 30U | spread(cell.x) | (spread(cell.y) << 1U) | (spread(cell.z) << 2U),
                       f);
  }
  std::ranges::stable_sort(keyed, {}, &std::pair<std::uint64_t, glm::uvec3>::first);
  std::ranges::transform(keyed, faces.begin(), &std::pair<std::uint64_t, glm::uvec3>::second);
}

TriangleSoup::Cone cone_of(const mesh::Mesh& mesh, std::span<const glm::uvec3> faces) {
  glm::vec3 sum(0.0F);
  for (const glm::uvec3& face : faces) sum += normal_of(mesh, face);
  const float length = glm::length(sum);
  if (length == 0.0F) return {};
  TriangleSoup::Cone cone{sum / length, 0.0F};
  float least = 1.0F;
  for (const glm::uvec3& face : faces) {
    const glm::vec3 normal = normal_of(mesh, face);
    if (normal != glm::vec3(0.0F)) least = std::min(least, glm::dot(cone.axis, normal));
  }
  cone.sine = least > 0.0F ? std::sqrt(std::max(0.0F, 1.0F - least * least)) + kConeRounding : 2.0F;
  return cone;
}

void put(TriangleSoup& soup, std::size_t place, std::size_t corner, const glm::vec3& v) {
  float* block = soup.blocks.data() + place / kSoupBlock * 9 * kSoupBlock;
  for (int axis = 0; axis < 3; ++axis) {
    block[(3 * corner + static_cast<std::size_t>(axis)) * kSoupBlock + place % kSoupBlock] = v[axis];
  }
}

/// Adds whole blocks.
void append(TriangleSoup& soup, std::vector<glm::uvec3> faces, const mesh::Mesh& mesh) {
  if (faces.empty()) return;
  const std::size_t before = soup.block_count() * kSoupBlock;
  const glm::uvec3 filler(faces.back().x);
  faces.resize((faces.size() + kSoupBlock - 1) / kSoupBlock * kSoupBlock, filler);
  soup.blocks.resize(soup.blocks.size() + 9 * faces.size());
  for (std::size_t place = 0; place < faces.size(); ++place) {
    for (int corner = 0; corner < 3; ++corner) {
      put(soup, before + place, static_cast<std::size_t>(corner), mesh.vertices[faces[place][corner]]);
    }
  }
}

}  // namespace

TriangleSoup soup_of(const mesh::Mesh& mesh) {
  SidedFaces faces = sided_faces(mesh);
  TriangleSoup soup;
  soup.box = box_of(mesh, finite_faces(mesh));
  sort_by_place(faces.front_only, mesh, soup.box, true);
  sort_by_place(faces.both, mesh, soup.box, false);
  for (std::size_t at = 0; at < faces.front_only.size(); at += kSoupBlock) {
    const std::size_t count = std::min(kSoupBlock, faces.front_only.size() - at);
    soup.cones.push_back(cone_of(mesh, std::span(faces.front_only).subspan(at, count)));
  }
  append(soup, std::move(faces.front_only), mesh);
  append(soup, std::move(faces.both), mesh);
  return soup;
}

}  // namespace rejoin::zbuffer::detail
