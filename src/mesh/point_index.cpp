#include "mesh/point_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace rejoin::mesh {
namespace {

struct Points {
  std::vector<glm::vec3> data;
  std::size_t kdtree_get_point_count() const { return data.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return data[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*unused*/) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3,
                                                 std::uint32_t>;

/// nanoflann's result of a search for the nearest point that starts with a limit, so that far parts of the tree
/// are never entered.
class NearestWithin {
 public:
  explicit NearestWithin(float squared_radius) : squared_(squared_radius) {}
  /// Is offered points of a leaf that are farther than others of that leaf, too.
  bool addPoint(float squared, std::uint32_t index) {
    if (squared >= squared_) return true;
    squared_ = squared;
    index_ = index;
    found_ = true;
    return true;
  }
  float worstDist() const { return squared_; }
  bool full() const { return found_; }
  std::uint32_t index() const { return index_; }

 private:
  float squared_;
  std::uint32_t index_ = 0;
  bool found_ = false;
};

}  // namespace

struct PointIndex::Impl {
  Points points;
  std::unique_ptr<Tree> tree;
};

PointIndex::PointIndex(std::span<const glm::vec3> points) : impl_(std::make_unique<Impl>()) {
  impl_->points.data.assign(points.begin(), points.end());
  if (points.empty()) return;
  impl_->tree = std::make_unique<Tree>(3, impl_->points, nanoflann::KDTreeSingleIndexAdaptorParams(12));
}

PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

void PointIndex::within(const glm::vec3& point, float radius, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (!impl_->tree) return;
  thread_local std::vector<std::pair<std::uint32_t, float>> matches;
  matches.clear();
  nanoflann::SearchParams params;
  params.sorted = false;
  impl_->tree->radiusSearch(&point.x, radius * radius, matches, params);
  for (const auto& match : matches) found.push_back(match.first);
  std::sort(found.begin(), found.end());
}

std::optional<std::pair<std::uint32_t, float>> PointIndex::nearest(const glm::vec3& point) const {
  return nearest_within(point, std::numeric_limits<float>::infinity());
}

std::optional<std::pair<std::uint32_t, float>> PointIndex::nearest_within(const glm::vec3& point,
                                                                          float radius) const {
  if (!impl_->tree) return std::nullopt;
  NearestWithin result(radius * radius);
  if (!impl_->tree->findNeighbors(result, &point.x, nanoflann::SearchParams())) return std::nullopt;
  return std::pair(result.index(), std::sqrt(result.worstDist()));
}

void PointIndex::nearest(const glm::vec3& point, std::size_t k, std::vector<std::uint32_t>& found) const {
  found.assign(std::min(k, impl_->points.data.size()), 0);
  if (!impl_->tree) return;
  thread_local std::vector<float> squared;
  squared.resize(found.size());
  impl_->tree->knnSearch(&point.x, found.size(), found.data(), squared.data());
}

}  // namespace rejoin::mesh
