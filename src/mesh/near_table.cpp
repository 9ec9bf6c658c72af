#include "mesh/near_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kMostCells = 1000.0F;  // a side, not more than 10 bits with the rim
constexpr float kRim = 2.0F;           // cells around what is in reach, so that no neighbour lies outside

std::uint32_t packed(const glm::uvec3& cell) {
  return cell.x | cell.y << 10U | cell.z << 20U;
}

glm::uvec3 unpacked(std::uint32_t cell) {
  return {cell & 1023U, cell >> 10U & 1023U, cell >> 20U};
}

}  // namespace

/// Hands points on from cell to cell, as long as they are nearer than what a cell has.
class NearTable::Spread {
 public:
  Spread(NearTable& table, float cell, float reach)
      : table_(table),
        none_(static_cast<std::uint32_t>(table.points_.size() - 1)),
        cell_(cell),
        middle_(table.low_ + 0.5F * cell),
        farthest_(reach * reach),
        squared_(table.nearest_.size(), std::numeric_limits<float>::infinity()) {}

  void run() {
    for (std::uint32_t k = 0; k < none_; ++k) {
      offer(glm::uvec3((table_.points_[k] - table_.low_) * table_.per_unit_), k);
    }
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const Entry entry = queue_[next];
      if (table_.nearest_[entry.place] != entry.point) continue;  // a nearer one has come since
      const glm::uvec3 cell = unpacked(entry.cell);
      for (int axis = 0; axis < 3; ++axis) {
        glm::uvec3 beside = cell;
        ++beside[axis];
        offer(beside, entry.point);
        beside[axis] -= 2U;
        offer(beside, entry.point);
      }
    }
  }

 private:
  struct Entry {
    std::uint32_t cell;
    std::uint32_t point;
    std::uint32_t place;
  };

  void offer(const glm::uvec3& cell, std::uint32_t point) {
    std::uint32_t& brick = table_.cells_of_brick_[table_.brick_of(cell)];
    const std::size_t in = inside(cell);
    if (table_.nearest_[brick + in] == point) return;
    const glm::vec3 off = middle_ + cell_ * glm::vec3(cell) - table_.points_[point];
    const float squared = glm::dot(off, off);
    if (squared > farthest_) return;
    if (brick == 0) {
      brick = static_cast<std::uint32_t>(table_.nearest_.size());
      table_.nearest_.resize(brick + std::size_t{kBrick} * kBrick * kBrick, none_);
      squared_.resize(table_.nearest_.size(), std::numeric_limits<float>::infinity());
    }
    const auto place = static_cast<std::uint32_t>(brick + in);
    if (squared >= squared_[place]) return;
    squared_[place] = squared;
    table_.nearest_[place] = point;
    queue_.push_back({packed(cell), point, place});
  }

  NearTable& table_;
  std::uint32_t none_;  ///< the point that stands for none
  float cell_;
  glm::vec3 middle_;  ///< of the first cell
  float farthest_;
  std::vector<float> squared_;
  std::vector<Entry> queue_;
};

NearTable::NearTable(std::span<const glm::vec3> points, float cell, float reach) {
  if (points.empty()) return;
  points_.insert(points_.begin(), points.begin(), points.end());
  std::fill(nearest_.begin(), nearest_.end(), static_cast<std::uint32_t>(points.size()));
  const Box box = bounds(points);
  const glm::vec3 size = box.high - box.low + 2.0F * reach;
  cell = std::max(cell, std::max({size.x, size.y, size.z}) / kMostCells);
  const float farthest =
      reach + std::sqrt(0.75F) * cell;  // of a middle, where a point of its cell is in reach
  low_ = box.low - (reach + kRim * cell);
  per_unit_ = 1.0F / cell;
  bricks_ = (glm::uvec3(size * per_unit_ + 2.0F * kRim) >> kBrickBits) + 1U;
  last_ = glm::vec3(bricks_ << kBrickBits) - 0.5F;
  cells_of_brick_.assign(std::size_t{bricks_.x} * bricks_.y * bricks_.z, 0);
  Spread(*this, cell, farthest).run();
}

}  // namespace rejoin::mesh
