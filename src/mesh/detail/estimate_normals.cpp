#include <algorithm>
#include <cmath>
#include <queue>

#include "core/parallel.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/detail/soup.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kNeighbours = 12;

/// An undecided point, reached from a decided one.
struct Step {
  float turn;  ///< 1 - |cos| between the two normals
  std::uint32_t from;
  std::uint32_t to;
  bool operator>(const Step& other) const {
    if (turn != other.turn) return turn > other.turn;
    return to != other.to ? to > other.to : from > other.from;
  }
};

/// Mutual neighbour lists: the k-nearest relation made symmetric, so that the walk reaches whole parts.
std::vector<std::vector<std::uint32_t>> neighbour_lists(const std::vector<glm::vec3>& points,
                                                        std::vector<glm::vec3>& normals) {
  const PointIndex index(points);
  std::vector<std::vector<std::uint32_t>> lists(points.size());
  parallel_for(points.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      index.nearest(points[i], kNeighbours, lists[i]);
      normals[i] = plane_normal(points, lists[i]);
    }
  });
  std::vector<std::vector<std::uint32_t>> both = lists;
  for (std::uint32_t i = 0; i < lists.size(); ++i) {
    for (const std::uint32_t k : lists[i]) both[k].push_back(i);
  }
  return both;
}

}  // namespace

std::vector<glm::vec3> estimate_normals(const std::vector<glm::vec3>& points) {
  std::vector<glm::vec3> normals(points.size());
  const std::vector<std::vector<std::uint32_t>> neighbours = neighbour_lists(points, normals);

  // The highest point of a part is on its outside, whatever its shape.
  std::vector<std::uint32_t> by_height(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) by_height[i] = i;
  std::stable_sort(by_height.begin(), by_height.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return points[a].z > points[b].z; });
  std::vector<bool> decided(points.size(), false);
  for (const std::uint32_t seed : by_height) {
    if (decided[seed]) continue;
    if (normals[seed].z < 0) normals[seed] = -normals[seed];
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
    const auto decide = [&](std::uint32_t i) {
      decided[i] = true;
      for (const std::uint32_t k : neighbours[i]) {
        if (!decided[k]) steps.push({1.0F - std::abs(glm::dot(normals[i], normals[k])), i, k});
      }
    };
    decide(seed);
    while (!steps.empty()) {
      const Step step = steps.top();
      steps.pop();
      if (decided[step.to]) continue;
      if (glm::dot(normals[step.from], normals[step.to]) < 0) normals[step.to] = -normals[step.to];
      decide(step.to);
    }
  }
  return normals;
}

}  // namespace rejoin::mesh::detail
