#include "mesh/detail/corner_grid.hpp"

#include <algorithm>
#include <utility>

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kCornersOfCell = 8;
constexpr std::size_t kMostLevels = 10;
constexpr double kSlack = 1e-9;  // of the whole size: more than places are rounded by

}  // namespace

CornerGrid::CornerGrid(std::vector<glm::dvec2> places)
    : places_(std::move(places)),
      low_(places_.front()),
      next_(places_.size(), kNone),
      before_(next_),
      cells_(next_) {
  glm::dvec2 high = low_;
  for (const glm::dvec2& place : places_) {
    low_ = glm::min(low_, place);
    high = glm::max(high, place);
  }
  if (const double size = std::max(high.x - low_.x, high.y - low_.y); size > 0) size_ = size;
  while (levels_ < kMostLevels && (kCornersOfCell << (2 * levels_)) < places_.size()) ++levels_;
  counts_.assign(first_of_level(levels_ + 1), 0);
  first_.assign(std::size_t{1} << (2 * levels_), kNone);
}

void CornerGrid::add(std::size_t corner) {
  const std::size_t side = std::size_t{1} << levels_;
  const glm::dvec2 share = (places_[corner] - low_) / size_ * static_cast<double>(side);
  const std::size_t column = std::min(static_cast<std::size_t>(share.x), side - 1);
  const std::size_t row = std::min(static_cast<std::size_t>(share.y), side - 1);
  const std::size_t cell = row * side + column;
  cells_[corner] = cell;
  before_[corner] = kNone;
  next_[corner] = first_[cell];
  if (next_[corner] != kNone) before_[next_[corner]] = corner;
  first_[cell] = corner;
  count(cell, 1);
}

void CornerGrid::remove(std::size_t corner) {
  const std::size_t cell = std::exchange(cells_[corner], kNone);
  if (next_[corner] != kNone) before_[next_[corner]] = before_[corner];
  (before_[corner] != kNone ? next_[before_[corner]] : first_[cell]) = next_[corner];
  count(cell, -1);
}

void CornerGrid::count(std::size_t cell, int change) {
  const std::size_t side = std::size_t{1} << levels_;
  for (std::size_t level = 0; level <= levels_; ++level) {
    const std::size_t smaller = levels_ - level;
    const std::size_t square = ((cell / side >> smaller) << level) + (cell % side >> smaller);
    counts_[first_of_level(level) + square] += static_cast<std::size_t>(change);
  }
}

bool CornerGrid::misses(const Triangle& triangle, std::size_t level, std::size_t column,
                        std::size_t row) const {
  const double size = size_ / static_cast<double>(std::size_t{1} << level);
  const glm::dvec2 slack(kSlack * size_);
  const glm::dvec2 low = low_ + size * glm::dvec2(column, row) - slack;
  const glm::dvec2 high = low + size + 2.0 * slack;
  const auto& [a, b, c] = triangle;
  const glm::dvec2 least = glm::min(a, glm::min(b, c));
  const glm::dvec2 most = glm::max(a, glm::max(b, c));
  if (most.x < low.x || most.y < low.y || least.x > high.x || least.y > high.y) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 along = triangle[(k + 1) % 3] - triangle[k];
    const glm::dvec2 inwards(-along.y, along.x);
    const glm::dvec2 innermost(inwards.x > 0 ? high.x : low.x, inwards.y > 0 ? high.y : low.y);
    if (glm::dot(inwards, innermost - triangle[k]) < 0) return true;
  }
  return false;
}

}  // namespace rejoin::mesh::detail
