/// Near points looked up instead of searched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace rejoin::mesh {

/// A point for every cell of a grid around points: the nearest to the cell's middle, or hardly farther.  What PointIndex searches is
/// one look here, with an answer that may be farther than the nearest point by twice a cell's diagonal, seldom by more than one.
/// Only cells within reach of a point are kept.  Const members may be called from several threads.
class NearTable {
 public:
  /// Without points.
  NearTable() = default;

  /// \param points  finite; the table keeps a copy
  /// \param cell    side of a cell, > 0; taken larger for points that spread over more than 1,000 cells
  /// \param reach   up to this distance points are found
  NearTable(std::span<const glm::vec3> points, float cell, float reach);

  /// A point that is closer than `radius` and nearly the nearest, and its distance.
  /// \param radius  beyond the reach of the table nothing is sure to be found
  std::optional<std::pair<std::uint32_t, float>> nearest_within(const glm::vec3& point, float radius) const {
    // Whether a cell has a point is as hard to foretell for the processor as how far it is, so all cells have one, and what
    // lies outside the grid goes to a cell at its end, which is out of reach of all.
    const glm::vec3 p = glm::min(glm::max(glm::vec3(0.0F), (point - low_) * per_unit_), last_);
    const glm::uvec3 cell(p);
    const std::uint32_t nearest = nearest_[cells_of_brick_[brick_of(cell)] + inside(cell)];
    const float distance = glm::distance(points_[nearest], point);
    if (!(distance < radius)) return std::nullopt;
    return std::pair(nearest, distance);
  }

 private:
  class Spread;
  static constexpr unsigned kBrickBits = 3;
  static constexpr unsigned kBrick = 1U << kBrickBits;  ///< cells a side of what is kept or not

  std::size_t brick_of(const glm::uvec3& cell) const {
    const glm::uvec3 b = cell >> kBrickBits;
    return (std::size_t{b.z} * bricks_.y + b.y) * bricks_.x + b.x;
  }
  static std::size_t inside(const glm::uvec3& cell) {
    const glm::uvec3 k = cell & (kBrick - 1U);
    return (k.z << 2U * kBrickBits) | (k.y << kBrickBits) | k.x;
  }

  static constexpr float kNowhere = std::numeric_limits<float>::infinity();

  std::vector<glm::vec3> points_{glm::vec3(kNowhere)};  ///< the last stands for none
  glm::vec3 low_{0.0F};                                 ///< corner of the grid
  float per_unit_ = 0;                                  ///< cells a unit of length
  glm::vec3 last_{0.0F};                                ///< inside the last cell
  glm::uvec3 bricks_{1};
  std::vector<std::uint32_t> cells_of_brick_{0};  ///< where its cells start; 0: it is not kept
  /// Of each cell: of a brick without points, then of those that are kept.
  std::vector<std::uint32_t> nearest_ = std::vector<std::uint32_t>(std::size_t{kBrick} * kBrick * kBrick, 0);
};

}  // namespace rejoin::mesh
