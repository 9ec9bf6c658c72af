#include "mesh/point_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "mesh/detail/kd_tree.hpp"
#include "mesh/detail/point_tree.hpp"

namespace rejoin::mesh {
/// Each of the trees is made when it is first asked: few users ask both.
struct PointIndex::Impl {
  detail::KdPoints points;
  std::once_flag made_tree;
  std::unique_ptr<detail::KdTree> tree;  ///< for all that are near
  std::once_flag made_nearest;
  detail::PointTree nearest;  ///< for the nearest

  const detail::KdTree& ready_tree() {
    std::call_once(made_tree, [this] {
      tree = std::make_unique<detail::KdTree>(3, points,
                                              nanoflann::KDTreeSingleIndexAdaptorParams(detail::kKdLeaf));
    });
    return *tree;
  }
  const detail::PointTree& ready_nearest() {
    std::call_once(made_nearest, [this] { nearest = detail::PointTree(points.data); });
    return nearest;
  }
};

PointIndex::PointIndex(std::span<const glm::vec3> points) : impl_(std::make_unique<Impl>()) {
  impl_->points.data.assign(points.begin(), points.end());
}

PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

void PointIndex::within(const glm::vec3& point, float radius, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (impl_->points.data.empty()) return;
  thread_local std::vector<std::pair<std::uint32_t, float>> matches;
  matches.clear();
  nanoflann::SearchParams params;
  params.sorted = false;
  impl_->ready_tree().radiusSearch(&point.x, radius * radius, matches, params);
  for (const auto& match : matches) found.push_back(match.first);
  std::sort(found.begin(), found.end());
}

std::optional<std::pair<std::uint32_t, float>> PointIndex::nearest(const glm::vec3& point) const {
  return nearest_within(point, std::numeric_limits<float>::infinity());
}

std::optional<std::pair<std::uint32_t, float>> PointIndex::nearest_within(const glm::vec3& point,
                                                                          float radius) const {
  float squared = radius * radius;
  std::uint32_t index = 0;
  if (!impl_->ready_nearest().nearest(point, squared, index)) return std::nullopt;
  return std::pair(index, std::sqrt(squared));
}

std::optional<std::pair<std::uint32_t, float>> PointIndex::nearest_within(const glm::vec3& point,
                                                                          float radius, Known& known) const {
  constexpr float kRounding = 1e-6F;  // of distances, several times
  const float moved = glm::distance(point, known.place);
  if (!known.nearest && moved + radius * (1.0F + kRounding) < known.room) return std::nullopt;
  if (known.nearest && moved < known.room) {
    // In the order of the search, so that the bits are the same.
    const glm::vec3 off = impl_->points.data[*known.nearest] - point;
    const float squared = off.x * off.x + off.y * off.y + off.z * off.z;
    if (!(squared < radius * radius)) return std::nullopt;
    return std::pair(*known.nearest, std::sqrt(squared));
  }
  float squared = radius * radius;
  float others = 0;
  std::uint32_t index = 0;
  const bool found = impl_->ready_nearest().nearest(point, squared, index, others);
  const float next = (1.0F - 4.0F * kRounding) * std::sqrt(others);
  known = {point, next, std::nullopt};
  if (!found) return std::nullopt;
  const float distance = std::sqrt(squared);
  known.nearest = index;
  known.room =
      0.499F * (next - distance);  // as much as it comes nearer to others it may go away from this one
  return std::pair(index, distance);
}

void PointIndex::nearest(const glm::vec3& point, std::size_t k, std::vector<std::uint32_t>& found) const {
  found.assign(std::min(k, impl_->points.data.size()), 0);
  if (impl_->points.data.empty()) return;
  thread_local std::vector<float> squared;
  squared.resize(found.size());
  impl_->ready_tree().knnSearch(&point.x, found.size(), found.data(), squared.data());
}

const std::vector<std::uint32_t>& PointIndex::by_place() const {
  return impl_->ready_tree().vAcc;
}

}  // namespace rejoin::mesh
