#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "zbuffer/detail/drawable.hpp"
#include "zbuffer/detail/outward.hpp"
#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer::detail {
namespace {

constexpr float kConeRounding = 0.0005F;  ///< by which a cone is wider than its normals, for they are rounded

glm::vec3 normal_of(const mesh::Mesh& mesh, const glm::uvec3& face) {
  const glm::dvec3 a(mesh.vertices[face.x]);
  const glm::dvec3 normal =
      glm::cross(glm::dvec3(mesh.vertices[face.y]) - a, glm::dvec3(mesh.vertices[face.z]) - a);
  const double length = glm::length(normal);
  return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0F);
}

/// How much less than a turn of its normal by a radian it counts that a face lies at the other end of the mesh.
constexpr float kPlaceWeight = 0.25F;

/// A face as a point: the place of its centre, weighted, and its normal.
struct Item {
  std::array<float, 6> at;
  glm::uvec3 face;
};

std::vector<Item> items_of(const std::vector<glm::uvec3>& faces, const mesh::Mesh& mesh,
                           const mesh::Box& box) {
  const glm::vec3 extent = box.high - box.low;
  const float longest = std::max({extent.x, extent.y, extent.z, std::numeric_limits<float>::min()});
  std::vector<Item> items;
  items.reserve(faces.size());
  for (const glm::uvec3& f : faces) {
    const glm::vec3 centre = (mesh.vertices[f.x] - box.low) / 3.0F + (mesh.vertices[f.y] - box.low) / 3.0F +
                             (mesh.vertices[f.z] - box.low) / 3.0F;
    const glm::vec3 place = centre / longest * kPlaceWeight;
    const glm::vec3 normal = normal_of(mesh, f);
    items.push_back({{place.x, place.y, place.z, normal.x, normal.y, normal.z}, f});
    for (float& x : items.back().at) x = std::isfinite(x) ? x : 0.0F;
  }
  return items;
}

std::size_t widest_axis(std::span<const Item> items) {
  auto low = items[0].at;
  auto high = low;
  for (const Item& item : items) {
    for (std::size_t k = 0; k < low.size(); ++k) {
      low[k] = std::min(low[k], item.at[k]);
      high[k] = std::max(high[k], item.at[k]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t k = 1; k < low.size(); ++k) {
    if (high[k] - low[k] > high[widest] - low[widest]) widest = k;
  }
  return widest;
}

/// Halves the faces, each half again and so on, across the axis along which they differ most, down to blocks.
void halve(std::span<Item> items) {
  if (items.size() <= kSoupBlock) return;
  const std::size_t blocks = (items.size() + kSoupBlock - 1) / kSoupBlock;
  const std::size_t middle = blocks / 2 * kSoupBlock;
  const auto by_axis = [axis = widest_axis(items)](const Item& item) { return item.at[axis]; };
  std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(middle), {}, by_axis);
  halve(items.first(middle));
  halve(items.subspan(middle));
}

/// Puts faces together that look the same way and lie close.  A block of such faces looks away as a whole more often, and
/// they are mostly of one size, so those that are drawn in step cover boxes of about the same number of pixels, and none
/// waits long for the others.
void gather_alike(std::vector<glm::uvec3>& faces, const mesh::Mesh& mesh, const mesh::Box& box) {
  std::vector<Item> items = items_of(faces, mesh, box);
  halve(items);
  std::ranges::transform(items, faces.begin(), &Item::face);
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
  gather_alike(faces.front_only, mesh, soup.box);
  gather_alike(faces.both, mesh, soup.box);
  for (std::size_t at = 0; at < faces.front_only.size(); at += kSoupBlock) {
    const std::size_t count = std::min(kSoupBlock, faces.front_only.size() - at);
    soup.cones.push_back(cone_of(mesh, std::span(faces.front_only).subspan(at, count)));
  }
  append(soup, std::move(faces.front_only), mesh);
  append(soup, std::move(faces.both), mesh);
  return soup;
}

}  // namespace rejoin::zbuffer::detail
