#include "mesh/detail/neighbour_lists.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace rejoin::mesh::detail {

NeighbourLists::NeighbourLists(const std::vector<glm::vec3>& points, const PointIndex& index,
                               std::size_t each)
    : points_(points.size()), each_(std::min(each, points.size())), lists_(points_ * each_) {
  const std::vector<std::uint32_t>& by_place = index.by_place();
  parallel_for(points_, 512, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> found;
    for (std::size_t k = first; k < last; ++k) {
      const std::size_t i = by_place[k];
      index.nearest(points[i], each_, found);
      std::ranges::copy(found, lists_.begin() + static_cast<std::ptrdiff_t>(i * each_));
    }
  });
}

}  // namespace rejoin::mesh::detail
