#include "mesh/detail/mean_normals.hpp"

#include "core/parallel.hpp"
#include "mesh/neighbours.hpp"

namespace rejoin::mesh::detail {

namespace {

std::vector<std::uint32_t> thinned(const std::vector<std::uint32_t>& list, std::size_t most) {
  const std::size_t step = (list.size() + most - 1) / most;
  std::vector<std::uint32_t> fewer;
  fewer.reserve(most);
  for (std::size_t k = 0; k < list.size(); k += step) fewer.push_back(list[k]);
  return fewer;
}

}  // namespace

Lists neighbours_within(std::span<const glm::vec3> points, double radius, std::size_t most) {
  const Neighbours neighbours(points, static_cast<float>(radius));
  Lists lists(points.size());
  parallel_for(points.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      neighbours.of(points[i], lists[i]);
      if (most > 0 && lists[i].size() > most) lists[i] = thinned(lists[i], most);
    }
  });
  return lists;
}

std::vector<glm::vec3> mean_normals(const std::vector<glm::vec3>& normals, const Lists& near, float alike) {
  std::vector<glm::vec3> means(normals.size());
  parallel_for(normals.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      glm::vec3 sum(0.0F);
      for (const auto k : near[i]) {
        if (glm::dot(normals[k], normals[i]) > alike) sum += normals[k];
      }
      const float length = glm::length(sum);
      means[i] = length > 0.0F ? sum / length : normals[i];
    }
  });
  return means;
}

}  // namespace rejoin::mesh::detail
