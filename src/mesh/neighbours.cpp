#include "mesh/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kMostCellsASide =
    200.0F;  // a side: for points that spread far, cells are wider than the radius

}  // namespace

Neighbours::Neighbours(std::span<const glm::vec3> points, float radius) : squared_radius_(radius * radius) {
  if (points.empty()) return;
  const Box box = bounds(points);
  low_ = box.low;
  const glm::vec3 size = box.high - box.low;
  // A little wider than the radius, so that rounding puts no neighbour into the cell after the next.
  const float cell = std::max(1.001F * radius, std::max({size.x, size.y, size.z}) / kMostCellsASide);
  per_unit_ = 1.0F / cell;
  cells_ = glm::ivec3(size * per_unit_) + 1;
  std::vector<std::size_t> place(points.size());
  first_.assign(place_of(0, 0, cells_.z) + 1, 0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const glm::ivec3 at = cell_of(points[k]);
    place[k] = place_of(at.x, at.y, at.z);
    ++first_[place[k] + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  points_.resize(points.size());
  numbers_.resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t to = next[place[k]]++;
    points_[to] = points[k];
    numbers_[to] = static_cast<std::uint32_t>(k);
  }
}

glm::ivec3 Neighbours::cell_of(const glm::vec3& point) const {
  // Far points are brought next to the grid first: they are farther than the radius from everything in it.
  const glm::vec3 at = glm::clamp((point - low_) * per_unit_, glm::vec3(-2.0F), glm::vec3(cells_ + 2));
  return glm::ivec3(glm::floor(at));
}

void Neighbours::of(const glm::vec3& point, std::vector<std::uint32_t>& found) const {
  found.clear();
  each(point, [&](std::uint32_t k) { found.push_back(k); });
  std::sort(found.begin(), found.end());
}

}  // namespace rejoin::mesh
