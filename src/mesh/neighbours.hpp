/// All neighbours of points within one distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::mesh {

/// Points sorted into cells as wide as the radius, for which neighbours are asked at most places: faster than PointIndex, and with
/// its very answers.  Const members may be called from several threads.
class Neighbours {
 public:
  /// \param points  finite
  /// \param radius  > 0
  Neighbours(std::span<const glm::vec3> points, float radius);

  /// Numbers of all points closer than the radius, in ascending order.
  void of(const glm::vec3& point, std::vector<std::uint32_t>& found) const;

 private:
  glm::ivec3 cell_of(const glm::vec3& point) const;
  std::size_t place_of(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_.y) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(cells_.x) +
           static_cast<std::size_t>(x);
  }

  float squared_radius_;
  glm::vec3 low_{0.0F};
  float per_unit_ = 0;
  glm::ivec3 cells_{0};
  std::vector<std::uint32_t> first_;    ///< of each cell, into the next two; one more at the end
  std::vector<glm::vec3> points_;       ///< cell by cell
  std::vector<std::uint32_t> numbers_;  ///< of these points
};

}  // namespace rejoin::mesh
