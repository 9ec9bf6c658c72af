/// Normals averaged over neighbourhoods.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::mesh::detail {

using Lists = std::vector<std::vector<std::uint32_t>>;

inline constexpr double kNormalRadius =
    2.0;  ///< samples' spacings over which their normals are averaged: about 12 neighbours

/// Of every point the points closer than the radius, itself among them.
/// \param most  where there are more, as in dense parts of uneven scans, up to so many of them, evenly, and perhaps not itself; 0: all
Lists neighbours_within(std::span<const glm::vec3> points, double radius, std::size_t most = 0);

/// Unit means over the neighbours that look about the same way, as the far side of a thin wall does not.
/// \param near   of every normal's point
/// \param alike  cosine of the angle to the point's own normal, above which a neighbour counts
std::vector<glm::vec3> mean_normals(const std::vector<glm::vec3>& normals, const Lists& near, float alike);

}  // namespace rejoin::mesh::detail
