#include "mesh/detail/cloud_parts.hpp"

#include "core/components.hpp"
#include "core/median.hpp"
#include "core/parallel.hpp"
#include "mesh/detail/parts.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr float kSparse = 2.5F;  // times the reach that is usual among its neighbours

/// Distance of every point from the furthest of its neighbours.
std::vector<float> reaches(const std::vector<glm::vec3>& points, const NeighbourLists& near) {
  std::vector<float> result(points.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = glm::distance(points[i], points[near[i].back()]);
  return result;
}

/// What is usual among every point's neighbours.
std::vector<float> usual_reach(const std::vector<float>& reach, const NeighbourLists& near) {
  std::vector<float> usual(reach.size());
  parallel_for(usual.size(), 512, [&](std::size_t first, std::size_t last) {
    std::vector<float> around;
    for (std::size_t i = first; i < last; ++i) {
      around.clear();
      for (const std::uint32_t k : near[i]) {
        if (k != i) around.push_back(reach[k]);
      }
      usual[i] = median(around);
    }
  });
  return usual;
}

}  // namespace

CloudParts parts_of_cloud(const std::vector<glm::vec3>& points, const NeighbourLists& near) {
  const std::size_t count = points.size();
  const std::vector<float> reach = reaches(points, near);
  const std::vector<float> usual = usual_reach(reach, near);
  CloudParts parts;
  parts.stray.resize(count);
  for (std::size_t i = 0; i < count; ++i) parts.stray[i] = reach[i] > kSparse * usual[i];

  Components components(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const std::uint32_t k : near[i]) {
      const float step = glm::distance(points[i], points[k]);
      if (!parts.stray[i] && !parts.stray[k] && step <= kSparse * usual[i]) components.unite(i, k);
    }
  }
  PartNumbers numbers(components, count);
  parts.part_of_point.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    parts.part_of_point.push_back(numbers.of(i));
    if (parts.part_of_point.back() == parts.count) ++parts.count;
  }
  return parts;
}

}  // namespace rejoin::mesh::detail
