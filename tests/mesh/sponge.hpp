/// A slab of spongy bone: two tables with a sponge of open cells between them.
#pragma once

#include <algorithm>
#include <cmath>

#include "shatter/surface_nets.hpp"

namespace rejoin::mesh::test {

inline constexpr glm::dvec3 kSpongeSize{40, 30, 8};
inline constexpr double kTable = 1.5;    // thickness of either table
inline constexpr double kCell = 4.0;     // period of the sponge
inline constexpr double kSpacing = 0.4;  // of the mesh
inline constexpr double kBone = 0.2;     // value of the gyroid below which bone is

/// Below 0 in the slab's bone; about distances.
inline double sponge(const glm::dvec3& p) {
  const glm::dvec3 off = glm::abs(p) - 0.5 * kSpongeSize;
  const double slab = std::max({off.x, off.y, off.z});
  const double turn = 2.0 * 3.141592653589793 / kCell;
  const glm::dvec3 s = glm::sin(turn * p);
  const glm::dvec3 c = glm::cos(turn * p);
  const double gyroid = s.x * c.y + s.y * c.z + s.z * c.x;
  const double bone = (gyroid - kBone) / (1.5 * turn);
  return std::max(slab, std::min(bone, -off.z - kTable));
}

/// The bone of the sponge on which `side` is below 0 as well.
template <class Side>
Mesh sponge_where(const Side& side) {
  const shatter::Grid grid{.size = 1.2 * kSpongeSize.x, .spacing = kSpacing};
  return shatter::surface_nets([&](const glm::dvec3& p) { return std::max(sponge(p), side(p)); }, grid,
                               Context{});
}

}  // namespace rejoin::mesh::test
