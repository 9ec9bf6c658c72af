#include "mesh/detail/weld.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/components.hpp"
#include "core/median.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(std::uint64_t h) {
  h ^= h >> 33U;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33U;
  h *= 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33U);
}

std::uint64_t hash_of(const glm::uvec3& key) {
  return mix(mix((static_cast<std::uint64_t>(key.x) << 32U) | key.y) ^ key.z);
}

/// Which keys have been seen, as the number of their first appearance (open addressing: a million keys in a
/// tenth of a second, where std::unordered_map takes one allocation each).
class FirstSeen {
 public:
  explicit FirstSeen(std::size_t expected) : slots_(std::bit_ceil(2 * expected + 1), kNone) {
    keys_.reserve(expected);
  }

  /// Number of the key's first appearance; a new key gets the next number.
  std::uint32_t number(const glm::uvec3& key) {
    std::size_t slot = hash_of(key) & (slots_.size() - 1);
    while (slots_[slot] != kNone && keys_[slots_[slot]] != key) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == kNone) {
      slots_[slot] = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slots_[slot];
  }

  std::size_t size() const { return keys_.size(); }

 private:
  std::vector<std::uint32_t> slots_;
  std::vector<glm::uvec3> keys_;
};

glm::uvec3 bits_of(const glm::vec3& point) {
  // Adding zero turns -0 into +0, the only two equal floats with different bits.
  return {std::bit_cast<std::uint32_t>(point.x + 0.0F), std::bit_cast<std::uint32_t>(point.y + 0.0F),
          std::bit_cast<std::uint32_t>(point.z + 0.0F)};
}

/// Corners turned so that the smallest index comes first: the same for faces with the same corners in the
/// same sense.
glm::uvec3 turned(const glm::uvec3& face) {
  if (face.x <= face.y && face.x <= face.z) return face;
  if (face.y <= face.z) return {face.y, face.z, face.x};
  return {face.z, face.x, face.y};
}

bool is_degenerate(const Mesh& mesh, const glm::uvec3& face) {
  if (face.x == face.y || face.y == face.z || face.z == face.x) return true;
  const glm::dvec3 a(mesh.vertices[face.x]);
  const glm::dvec3 cross =
      glm::cross(glm::dvec3(mesh.vertices[face.y]) - a, glm::dvec3(mesh.vertices[face.z]) - a);
  return cross == glm::dvec3(0.0);
}

}  // namespace

void weld(Mesh& mesh, Weld which) {
  FirstSeen seen(mesh.vertices.size());
  FirstSeen places(which == Weld::Places ? 0 : mesh.vertices.size());
  const auto key_of = [&](std::size_t i) {
    const glm::uvec3 place = bits_of(mesh.vertices[i]);
    if (which == Weld::Places || mesh.colours.empty()) return place;
    const glm::u8vec3 colour = mesh.colours[i];
    return glm::uvec3(places.number(place), (colour.x << 16) | (colour.y << 8) | colour.z, 0);
  };
  std::vector<std::uint32_t> renumbered(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const std::size_t before = seen.size();
    const std::uint32_t number = seen.number(key_of(i));
    renumbered[i] = number;
    const bool is_new = seen.size() != before;
    if (is_new) mesh.vertices[number] = mesh.vertices[i];
    if (is_new && !mesh.colours.empty()) mesh.colours[number] = mesh.colours[i];
    if (mesh.normals.empty()) continue;
    mesh.normals[number] = is_new ? mesh.normals[i] : mesh.normals[number] + mesh.normals[i];
  }
  mesh.vertices.resize(seen.size());
  if (!mesh.normals.empty()) mesh.normals.resize(seen.size());
  if (!mesh.colours.empty()) mesh.colours.resize(seen.size());
  for (glm::uvec3& face : mesh.faces) face = {renumbered[face.x], renumbered[face.y], renumbered[face.z]};
}

bool is_loose(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const glm::uvec3& face : mesh.faces) used[face.x] = used[face.y] = used[face.z] = true;
  const auto vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  return 2 * vertices > 3 * mesh.faces.size();
}

void weld_near(Mesh& mesh) {
  constexpr float kNear = 0.01F;  // of the median edge
  std::vector<float> edges;
  for (const glm::uvec3& face : mesh.faces)
    edges.push_back(glm::distance(mesh.vertices[face.x], mesh.vertices[face.y]));
  const float radius = kNear * median(edges);
  const PointIndex index(mesh.vertices);
  Components places(mesh.vertices.size());
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    index.within(mesh.vertices[i], radius, near);
    for (const std::uint32_t k : near) places.unite(i, k);
  }
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i] = mesh.vertices[places.of(i)];
  weld(mesh);
}

Dropped drop_useless_faces(Mesh& mesh) {
  Dropped dropped;
  FirstSeen seen(mesh.faces.size());
  std::size_t kept = 0;
  for (const glm::uvec3 face : mesh.faces) {
    if (is_degenerate(mesh, face)) {
      ++dropped.degenerate;
      continue;
    }
    const std::size_t before = seen.size();
    seen.number(turned(face));
    if (seen.size() == before) {
      ++dropped.duplicate;
    } else {
      mesh.faces[kept++] = face;
    }
  }
  mesh.faces.resize(kept);
  return dropped;
}

std::size_t drop_backs(Mesh& mesh) {
  if (mesh.faces.size() <= 3 * mesh.vertices.size()) return 0;
  FirstSeen seen(mesh.faces.size());
  std::vector<glm::uvec3> fronts;
  for (const glm::uvec3& face : mesh.faces) {
    std::array<std::uint32_t, 3> corners{face.x, face.y, face.z};
    std::sort(corners.begin(), corners.end());
    const std::size_t before = seen.size();
    seen.number({corners[0], corners[1], corners[2]});
    if (seen.size() != before) fronts.push_back(face);
  }
  const std::size_t backs = mesh.faces.size() - fronts.size();
  if (4 * backs < mesh.faces.size()) return 0;
  mesh.faces = std::move(fronts);
  return backs;
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), kNone);
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) renumbered[face[k]] = 0;
  }
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] == kNone) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[i];
    if (!mesh.colours.empty()) mesh.colours[kept] = mesh.colours[i];
    renumbered[i] = kept++;
  }
  mesh.vertices.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.colours.empty()) mesh.colours.resize(kept);
  for (glm::uvec3& face : mesh.faces) face = {renumbered[face.x], renumbered[face.y], renumbered[face.z]};
}

}  // namespace rejoin::mesh::detail
