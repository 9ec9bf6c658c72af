#include "mesh/near_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
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
      : table_(table), cell_(cell), middle_(table.low_ + 0.5F * cell), farthest_(reach * reach) {}

  void run() {
    for (std::uint32_t k = 0; k < table_.points_.size(); ++k) {
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
    if (brick != kNone && table_.nearest_[brick + in] == point) return;
    const glm::vec3 off = middle_ + cell_ * glm::vec3(cell) - table_.points_[point];
    const float squared = glm::dot(off, off);
    if (squared > farthest_) return;
    if (brick == kNone) {
      brick = static_cast<std::uint32_t>(table_.nearest_.size());
      table_.nearest_.resize(brick + std::size_t{kBrick} * kBrick * kBrick, kNone);
      squared_.resize(table_.nearest_.size(), std::numeric_limits<float>::infinity());
    }
    const auto place = static_cast<std::uint32_t>(brick + in);
    if (squared >= squared_[place]) return;
    squared_[place] = squared;
    table_.nearest_[place] = point;
    queue_.push_back({packed(cell), point, place});
  }

  NearTable& table_;
  float cell_;
  glm::vec3 middle_;  ///< of the first cell
  float farthest_;
  std::vector<float> squared_;
  std::vector<Entry> queue_;
};

NearTable::NearTable(std::span<const glm::vec3> points, float cell, float reach)
    : points_(points.begin(), points.end()) {
  if (points.empty()) return;
  const Box box = bounds(points_);
  const glm::vec3 size = box.high - box.low + 2.0F * reach;
  cell = std::max(cell, std::max({size.x, size.y, size.z}) / kMostCells);
  const float farthest =
      reach + std::sqrt(0.75F) * cell;  // of a middle, where a point of its cell is in reach
  low_ = box.low - (reach + kRim * cell);
  per_unit_ = 1.0F / cell;
  bricks_ = (glm::uvec3(size * per_unit_ + 2.0F * kRim) >> kBrickBits) + 1U;
  cells_of_brick_.assign(std::size_t{bricks_.x} * bricks_.y * bricks_.z, kNone);
  Spread(*this, cell, farthest).run();
}

std::optional<std::pair<std::uint32_t, float>> NearTable::nearest_within(const glm::vec3& point,
                                                                         float radius) const {
  const glm::vec3 p = (point - low_) * per_unit_;
  const glm::vec3 end(bricks_ << kBrickBits);
  if (!(p.x >= 0.0F && p.y >= 0.0F && p.z >= 0.0F && p.x < end.x && p.y < end.y && p.z < end.z))
    return std::nullopt;
  const glm::uvec3 cell(p);
  const std::uint32_t brick = cells_of_brick_[brick_of(cell)];
  if (brick == kNone) return std::nullopt;
  const std::uint32_t nearest = nearest_[brick + inside(cell)];
  if (nearest == kNone) return std::nullopt;
  const float distance = glm::distance(points_[nearest], point);
  if (!(distance < radius)) return std::nullopt;
  return std::pair(nearest, distance);
}

}  // namespace rejoin::mesh
