/// What of a cloud hangs together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/detail/neighbour_lists.hpp"

namespace rejoin::mesh::detail {

struct CloudParts {
  std::vector<bool> stray;  ///< of every point: its neighbourhood is much emptier than its neighbours' are
  std::vector<std::uint32_t> part_of_point;  ///< by number; a stray is one alone
  std::uint32_t count = 0;
};

/// Points hang together that are neighbours no farther apart than 2.5 times as far as neighbourhoods reach there, some five spacings;
/// strays (after the local outlier factor, Breunig et al. 2000) hang together with nothing.
/// \param near  of the points
CloudParts parts_of_cloud(const std::vector<glm::vec3>& points, const NeighbourLists& near);

}  // namespace rejoin::mesh::detail
