#include "assembly/depth_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rejoin::assembly {
namespace {

constexpr int kCells = 40;  // along the longest edge
constexpr int kBlock = 4;   // cells of a block, which is looked at first

float most_depth(const match::GapField& gap, const glm::vec3& middle, float edge) {
  const auto nearest = gap.at(middle, std::numeric_limits<float>::max());
  const float half_diagonal = 0.5F * std::sqrt(3.0F) * edge;
  return nearest ? std::max(0.0F, half_diagonal - nearest->gap) : 0.0F;
}

}  // namespace

DepthBound::DepthBound(const match::GapField& gap) : box_(mesh::bounds(gap.surface())) {
  const glm::vec3 size = box_.high - box_.low;
  cell_ = std::max({size.x, size.y, size.z}) / kCells;
  if (!(cell_ > 0)) return;
  count_ = glm::min(glm::ivec3(size / cell_) + 1, glm::ivec3(kCells));
  bound_.assign(static_cast<std::size_t>(count_.x) * count_.y * count_.z, 0.0F);
  const auto middle_of = [&](const glm::ivec3& first, int cells) {
    return box_.low + cell_ * (glm::vec3(first) + 0.5F * static_cast<float>(cells));
  };
  const auto fill_block = [&](const glm::ivec3& first) {
    if (most_depth(gap, middle_of(first, kBlock), kBlock * cell_) <= 0) return;
    const glm::ivec3 end = glm::min(first + kBlock, count_);
    for (int z = first.z; z < end.z; ++z)
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x)
          bound_[(static_cast<std::size_t>(z) * count_.y + y) * count_.x + x] =
              most_depth(gap, middle_of({x, y, z}, 1), cell_);
  };
  for (int z = 0; z < count_.z; z += kBlock)
    for (int y = 0; y < count_.y; y += kBlock)
      for (int x = 0; x < count_.x; x += kBlock) fill_block({x, y, z});
}

float DepthBound::at(const glm::vec3& point) const {
  if (bound_.empty()) return std::numeric_limits<float>::max();
  const glm::vec3 from_low = point - box_.low;
  if (glm::any(glm::lessThan(from_low, glm::vec3(0))) || glm::any(glm::greaterThan(point, box_.high)))
    return 0;
  const glm::ivec3 cell = glm::min(glm::ivec3(from_low / cell_), count_ - 1);
  return bound_[(static_cast<std::size_t>(cell.z) * count_.y + cell.y) * count_.x + cell.x];
}

}  // namespace rejoin::assembly
