/// Sheets that hang on a mesh, as a scan has of what the piece lay on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::test {

inline constexpr int kRows = 28;           // of a sheet
inline constexpr float kSheetLength = 14;  // along them

/// Adds an open sheet of kRows rows that begins at vertices of the mesh and shares them.
/// \param starts  whether it begins at a vertex   \param across  in whose order along this direction
/// \param place  (distance from the seam, place along `across`) -> offset from the vertex where it began
template <class Starts, class Place>
void hang_sheet(Mesh& mesh, const Starts& starts, const glm::vec3& across, const Place& place) {
  std::vector<std::uint32_t> row;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    if (starts(mesh.vertices[i])) row.push_back(i);
  }
  const auto along = [&](std::uint32_t i) { return glm::dot(mesh.vertices[i], across); };
  std::ranges::sort(row, {}, along);
  const std::vector<std::uint32_t> seam = row;
  for (int k = 1; k <= kRows; ++k) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t i : seam) {
      next.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      const float far = kSheetLength * static_cast<float>(k) / static_cast<float>(kRows);
      mesh.vertices.push_back(mesh.vertices[i] + place(far, along(i)));
    }
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      mesh.faces.emplace_back(row[i], next[i], next[i + 1]);
      mesh.faces.emplace_back(row[i], next[i + 1], row[i + 1]);
    }
    row = next;
  }
}

}  // namespace rejoin::mesh::test
