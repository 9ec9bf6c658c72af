#include <meshoptimizer.h>

#include <limits>

#include "mesh/surface.hpp"

namespace rejoin::mesh {
namespace {

/// The mesh of the given corners, with the vertices that they use.
Mesh compact(const Mesh& mesh, const std::vector<unsigned int>& corners) {
  Mesh shell;
  shell.origin = mesh.origin;
  shell.vertices = mesh.vertices;
  shell.normals = mesh.normals;
  shell.colours = mesh.colours;
  std::vector<std::uint32_t> all;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    all.push_back(static_cast<std::uint32_t>(shell.faces.size()));
    shell.faces.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
  }
  return submesh(shell, all);
}

}  // namespace

Mesh simplify(const Mesh& mesh, std::size_t face_budget) {
  if (mesh.faces.size() <= face_budget) return mesh;
  std::vector<unsigned int> corners;
  corners.reserve(3 * mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) corners.insert(corners.end(), {face.x, face.y, face.z});
  const float* positions = &mesh.vertices.front().x;
  const std::size_t count = mesh.vertices.size();
  constexpr float kAnyError = std::numeric_limits<float>::max();

  std::vector<unsigned int> fewer(corners.size());
  fewer.resize(meshopt_simplify(fewer.data(), corners.data(), corners.size(), positions, count,
                                sizeof(glm::vec3), 3 * face_budget, kAnyError));
  // Non-manifold places are locked: where there are many of them the quadric simplifier stops far above the
  // budget.
  if (fewer.size() > 3 * face_budget + 3 * face_budget / 5) {
    std::vector<unsigned int> clustered(corners.size());
    clustered.resize(meshopt_simplifySloppy(clustered.data(), corners.data(), corners.size(), positions,
                                            count, sizeof(glm::vec3), 3 * face_budget, kAnyError, nullptr));
    if (!clustered.empty()) fewer = std::move(clustered);
  }
  return fewer.empty() ? mesh : compact(mesh, fewer);
}

}  // namespace rejoin::mesh
