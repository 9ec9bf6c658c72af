/// Neighbours of all points of a cloud.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "mesh/point_index.hpp"

namespace rejoin::mesh::detail {

inline constexpr std::size_t kNeighbours = 12;      ///< each point itself among them
inline constexpr std::size_t kWideNeighbours = 24;  ///< as many as a surface through the points needs

/// As many neighbours of every point, nearest first.
class NeighbourLists {
 public:
  /// The `each` nearest of every point; all, where there are fewer.
  /// \param index  of the points
  NeighbourLists(const std::vector<glm::vec3>& points, const PointIndex& index, std::size_t each);

  std::size_t size() const { return points_; }  ///< points
  std::size_t each() const { return each_; }
  std::span<const std::uint32_t> operator[](std::size_t point) const {
    return std::span(lists_).subspan(point * each_, each_);
  }

 private:
  std::size_t points_;
  std::size_t each_;
  std::vector<std::uint32_t> lists_;
};

/// Neighbours of the points of one cloud, looked for when they are first asked and kept, as most of the time of loading a large cloud
/// goes into that.  Not thread-safe.
class CloudNeighbours {
 public:
  /// \param points  outlive this, and stay as they are
  explicit CloudNeighbours(const std::vector<glm::vec3>& points) : points_(points), index_(points) {}

  const NeighbourLists& near() { return ready(near_, kNeighbours); }
  const NeighbourLists& wide() { return ready(wide_, kWideNeighbours); }

 private:
  const NeighbourLists& ready(std::optional<NeighbourLists>& lists, std::size_t each) {
    if (!lists) lists.emplace(points_, index_, each);
    return *lists;
  }

  const std::vector<glm::vec3>& points_;
  PointIndex index_;
  std::optional<NeighbourLists> near_;
  std::optional<NeighbourLists> wide_;
};

}  // namespace rejoin::mesh::detail
