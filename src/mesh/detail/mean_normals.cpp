#include "mesh/detail/mean_normals.hpp"

#include "core/parallel.hpp"
#include "mesh/neighbours.hpp"

namespace rejoin::mesh::detail {

Lists neighbours_within(std::span<const glm::vec3> points, double radius) {
  const Neighbours neighbours(points, static_cast<float>(radius));
  Lists lists(points.size());
  parallel_for(points.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) neighbours.of(points[i], lists[i]);
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
