#include "mesh/detail/enclosed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "mesh/detail/parts.hpp"
#include "mesh/ray_scene.hpp"

namespace rejoin::mesh::detail {
namespace {

/// Askew to the axes, along which the faces of segmented scans lie.
const std::array<glm::vec3, 6> kWaysOut{
    glm::normalize(glm::vec3(0.83F, 0.41F, 0.27F)),   glm::normalize(glm::vec3(-0.71F, 0.53F, -0.39F)),
    glm::normalize(glm::vec3(0.29F, -0.87F, 0.43F)),  glm::normalize(glm::vec3(-0.37F, -0.31F, 0.89F)),
    glm::normalize(glm::vec3(0.47F, -0.23F, -0.79F)), glm::normalize(glm::vec3(-0.59F, 0.67F, 0.33F))};

constexpr std::size_t kPlaces = 64;

bool leaves_oddly(const RayScene& scene, const glm::vec3& start, const glm::vec3& direction) {
  constexpr int kMostCrossings = 1000;
  int crossings = 0;
  float from = 0.0F;
  while (crossings < kMostCrossings) {
    const auto hit = scene.first_hit(start, direction, from, std::numeric_limits<float>::max());
    if (!hit) break;
    ++crossings;
    from = std::nextafter(hit->distance * (1.0F + 1e-6F), std::numeric_limits<float>::max());
  }
  return crossings % 2 == 1;
}

/// Of a part, by places all over it: a handle that was modelled apart from its vessel ends inside.
bool lies_inside(const RayScene& scene, const Mesh& mesh, const std::vector<std::uint32_t>& faces) {
  const std::size_t step = std::max<std::size_t>(1, faces.size() / kPlaces);
  for (std::size_t k = 0; k < faces.size(); k += step) {
    const glm::vec3& start = mesh.vertices[mesh.faces[faces[k]].x];
    if (!std::ranges::all_of(
            kWaysOut, [&](const glm::vec3& direction) { return leaves_oddly(scene, start, direction); }))
      return false;
  }
  return true;
}

/// Which parts are closed: every edge of theirs has an even number of faces.
std::vector<char> closed_parts(const Mesh& mesh, const std::vector<std::uint32_t>& part_of_face,
                               std::size_t parts, std::uint32_t largest) {
  std::vector<std::array<std::uint32_t, 3>> edges;  // both ends, and the part
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (part_of_face[f] == largest) continue;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]});
      edges.push_back({low, high, part_of_face[f]});
    }
  }
  std::ranges::sort(edges);
  std::vector<char> closed(parts, 1);
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const auto& other) { return other != *edge; });
    if ((next - edge) % 2 == 1) closed[edge->back()] = 0;
    edge = next;
  }
  return closed;
}

}  // namespace

Enclosed drop_enclosed(Mesh& mesh) {
  const std::vector<std::uint32_t> part_of_face = part_of_faces(mesh);
  const std::vector<Part> parts = measured_parts(mesh, part_of_face);
  if (parts.size() < 2) return {};
  const auto largest = static_cast<std::uint32_t>(
      std::ranges::max_element(parts, {}, [](const Part& part) { return part.weight; }) - parts.begin());
  const std::vector<char> closed = closed_parts(mesh, part_of_face, parts.size(), largest);
  if (std::ranges::count(closed, 1) < 2) return {};  // the largest is not looked at
  const std::vector<std::vector<std::uint32_t>> faces = members_of_parts(part_of_face, parts.size());
  const Mesh around = submesh(mesh, faces[largest]);
  const RayScene scene(around);
  std::vector<char> inside(parts.size(), 0);
  parallel_for(parts.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (k == largest || closed[k] == 0) continue;
      inside[k] = lies_inside(scene, mesh, faces[k]) ? 1 : 0;
    }
  });
  Enclosed dropped;
  dropped.parts = static_cast<std::size_t>(std::ranges::count(inside, 1));
  if (dropped.parts == 0) return dropped;
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (inside[part_of_face[f]] == 0) mesh.faces[kept++] = mesh.faces[f];
  dropped.faces = mesh.faces.size() - kept;
  mesh.faces.resize(kept);
  return dropped;
}

}  // namespace rejoin::mesh::detail
