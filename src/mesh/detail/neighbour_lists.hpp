/// Neighbours of all points of a cloud.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace rejoin::mesh::detail {

inline constexpr std::size_t kNeighbours = 12;  ///< each point itself among them

using NeighbourLists = std::vector<std::vector<std::uint32_t>>;  ///< nearest first

/// The kNeighbours nearest of every point; all, where there are fewer.
NeighbourLists neighbours_of(const std::vector<glm::vec3>& points);

}  // namespace rejoin::mesh::detail
