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

  /// Calls `visit(number)` for all points closer than the radius, in the order of their cells: faster where the order does not matter.
  template <typename Visit>
  void each(const glm::vec3& point, const Visit& visit) const {
    any(point, [&](std::uint32_t k) {
      visit(k);
      return false;
    });
  }

  /// Whether `holds(number)` for some point closer than the radius.
  template <typename Holds>
  bool any(const glm::vec3& point, const Holds& holds) const {
    const glm::ivec3 middle = cell_of(point);
    const glm::ivec3 from = glm::max(middle - 1, 0);
    const glm::ivec3 to = glm::min(middle + 1, cells_ - 1);
    if (from.x > to.x) return false;
    for (int z = from.z; z <= to.z; ++z) {
      for (int y = from.y; y <= to.y; ++y) {
        const std::uint32_t end = first_[place_of(to.x, y, z) + 1];
        for (std::uint32_t k = first_[place_of(from.x, y, z)]; k < end; ++k) {
          const glm::vec3 off = point - points_[k];
          if (off.x * off.x + off.y * off.y + off.z * off.z < squared_radius_ && holds(numbers_[k]))
            return true;
        }
      }
    }
    return false;
  }

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
