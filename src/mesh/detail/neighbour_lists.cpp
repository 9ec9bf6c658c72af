#include "mesh/detail/neighbour_lists.hpp"

#include "core/parallel.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh::detail {

NeighbourLists neighbours_of(const std::vector<glm::vec3>& points) {
  const PointIndex index(points);
  NeighbourLists lists(points.size());
  parallel_for(points.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) index.nearest(points[i], kNeighbours, lists[i]);
  });
  return lists;
}

}  // namespace rejoin::mesh::detail
