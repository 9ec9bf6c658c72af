/// Made scans of pieces on a table.
#pragma once

#include <functional>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::test {

/// z over (x, y) in -100 .. 100, seen from above.
inline Mesh relief(const std::function<float(float, float)>& height, int cells = 80) {
  Mesh mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const float x = 200.0F * static_cast<float>(i) / static_cast<float>(cells) - 100.0F;
      const float y = 200.0F * static_cast<float>(j) / static_cast<float>(cells) - 100.0F;
      mesh.vertices.emplace_back(x, y, height(x, y));
    }
  }
  const auto row = static_cast<std::uint32_t>(cells) + 1;
  for (std::uint32_t i = 0; i + 1 < row; ++i) {
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t k = i * row + j;
      mesh.faces.emplace_back(k, k + row, k + row + 1);
      mesh.faces.emplace_back(k, k + row + 1, k + 1);
    }
  }
  return mesh;
}

inline Mesh moved(Mesh mesh, const glm::vec3& by) {
  for (glm::vec3& vertex : mesh.vertices) vertex += by;
  return mesh;
}

/// Both in one mesh, or in one cloud.
inline Mesh together(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  for (const glm::uvec3& face : b.faces) a.faces.push_back(face + first);
  return a;
}

/// A rectangle of z = 0, of two faces, that faces up.
inline Mesh plate(float half) {
  Mesh mesh;
  mesh.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace rejoin::mesh::test
