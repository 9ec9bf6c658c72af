#include "mesh/filled_holes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/components.hpp"
#include "mesh/area_normals.hpp"
#include "mesh/noise.hpp"
#include "mesh/rings.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kSmoother =
    0.4F;  // than a quarter of the scan is, at most: noise alone makes few vertices in a row so
constexpr std::size_t kLeastCore = 30;  // vertices
constexpr int kRings = 2;               // about a vertex by which its roughness is told
constexpr std::size_t kSmoothest = 4;   // one vertex in so many is smoother than the scan's noise

/// How far vertices lie off the middle of their ring, along the normal.
std::vector<float> bumps(const Mesh& mesh, const Rings& rings) {
  const std::vector<glm::vec3> normals = area_normals(mesh);
  std::vector<float> result(rings.size(), 0.0F);
  for (std::size_t v = 0; v < rings.size(); ++v) {
    const float length = glm::length(normals[v]);
    if (rings.of(v).empty() || !(length > 0.0F)) continue;
    glm::vec3 sum(0.0F);
    for (const std::uint32_t k : rings.of(v)) sum += mesh.vertices[k] - mesh.vertices[v];
    result[v] = -glm::dot(sum, normals[v]) / (length * static_cast<float>(rings.of(v).size()));
  }
  return result;
}

/// How unlike bumps beside each other are, rms over every vertex and its ring: even curvature counts nothing.
std::vector<float> roughness(const std::vector<float>& bumps, const Rings& rings) {
  const auto mean_beside = [&](std::size_t v, const std::vector<float>& values) {
    float sum = 0.0F;
    for (const std::uint32_t k : rings.of(v)) sum += values[k];
    return sum / static_cast<float>(std::max<std::size_t>(1, rings.of(v).size()));
  };
  std::vector<float> squares(bumps.size());
  for (std::size_t v = 0; v < bumps.size(); ++v) {
    const float off = bumps[v] - mean_beside(v, bumps);
    squares[v] = off * off;
  }
  std::vector<float> result(bumps.size());
  for (std::size_t v = 0; v < bumps.size(); ++v) {
    const auto count = static_cast<float>(rings.of(v).size());
    result[v] = std::sqrt((squares[v] + count * mean_beside(v, squares)) / (1.0F + count));
  }
  return result;
}

/// The chosen vertices that hang together in patches of so many at least.
std::vector<char> in_patches(const std::vector<char>& chosen, const Rings& rings, std::size_t least) {
  Components patches(chosen.size());
  for (std::uint32_t v = 0; v < chosen.size(); ++v)
    for (const std::uint32_t k : rings.of(v))
      if (chosen[v] != 0 && chosen[k] != 0) patches.unite(v, k);
  std::vector<std::size_t> counts(chosen.size(), 0);
  for (std::uint32_t v = 0; v < chosen.size(); ++v) counts[patches.of(v)] += chosen[v] != 0 ? 1 : 0;
  std::vector<char> result(chosen.size(), 0);
  for (std::uint32_t v = 0; v < chosen.size(); ++v)
    result[v] = chosen[v] != 0 && counts[patches.of(v)] >= least ? 1 : 0;
  return result;
}

}  // namespace

std::vector<std::uint32_t> filled_holes(const Mesh& mesh) {
  const Rings rings(mesh);
  const std::vector<float> rough = roughness(bumps(mesh, rings), rings);
  std::vector<float> sorted = rough;
  const auto quarter = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / kSmoothest);
  std::nth_element(sorted.begin(), quarter, sorted.end());
  std::vector<char> smooth(rough.size());
  for (std::size_t v = 0; v < rough.size(); ++v) smooth[v] = rough[v] < kSmoother * *quarter ? 1 : 0;
  std::vector<char> filled = in_patches(smooth, rings, kLeastCore);
  if (std::ranges::count(filled, 1) == 0 || !is_of_scanner(noise(mesh), mesh)) return {};
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<char> inner = filled;
    for (std::size_t v = 0; v < inner.size(); ++v)
      if (inner[v] != 0)
        for (const std::uint32_t k : rings.of(v)) filled[k] = 1;
  }
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3& face = mesh.faces[f];
    if (filled[face.x] != 0 && filled[face.y] != 0 && filled[face.z] != 0) faces.push_back(f);
  }
  return faces;
}

}  // namespace rejoin::mesh
