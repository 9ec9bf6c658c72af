#include "mesh/detail/point_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/detail/point_tree.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rejoin::mesh::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kPointsAtOnce>;
using Vector = hn::Vec<Tag>;

/// What is still to be looked into.
struct Waiting {
  float squared;
  std::int32_t child;
};

constexpr std::size_t kMostWaiting = 128;  // 15 a level and 16 on the last; 2^31 points are 8 levels

/// Squared distances of points or boxes by `distance(tag, first lane, axis)`, and a bit for each that is below the limit.
template <typename Distance>
HWY_INLINE unsigned below(float limit, float* squared, const Distance& distance) {
  const Tag d;
  unsigned bits = 0;
  for (std::size_t k = 0; k < kPointsAtOnce; k += hn::Lanes(d)) {
    const Vector x = distance(d, k, 0);
    const Vector y = distance(d, k, 1);
    const Vector z = distance(d, k, 2);
    const Vector sum = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    hn::StoreU(sum, d, squared + k);
    std::uint8_t byte[8] = {};
    hn::StoreMaskBits(d, hn::Lt(sum, hn::Set(d, limit)), byte);
    bits |= (static_cast<unsigned>(byte[0]) | static_cast<unsigned>(byte[1]) << 8U) << k;
  }
  return bits;
}

bool search(const PointNode* nodes, const PointLeaf* leaves, const glm::vec3& point, float& best,
            std::uint32_t& index) {
  std::array<Waiting, kMostWaiting> waiting;
  std::size_t count = 0;
  std::int32_t at = 0;
  bool found = false;
  alignas(64) float squared[kPointsAtOnce];
  while (true) {
    if (at >= 0) {
      const PointNode& node = nodes[at];
      unsigned bits = below(best, squared, [&](const Tag d, std::size_t k, int axis) HWY_ATTR {
        const Vector p = hn::Set(d, point[axis]);
        return hn::Max(hn::Zero(d), hn::Max(hn::Sub(hn::LoadU(d, node.low[axis] + k), p),
                                            hn::Sub(p, hn::LoadU(d, node.high[axis] + k))));
      });
      // The nearest box next; of the others most will be too far by the time they are looked at, so they are not sorted.
      std::size_t nearest = count;
      for (; bits != 0; bits &= bits - 1) {
        const auto k = static_cast<std::size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
        waiting[count] = {squared[k], node.child[k]};
        if (squared[k] < waiting[nearest].squared) nearest = count;
        ++count;
      }
      if (nearest < count) std::swap(waiting[nearest], waiting[count - 1]);
    } else {
      const PointLeaf& leaf = leaves[~at];
      unsigned bits = below(best, squared, [&](const Tag d, std::size_t k, int axis) HWY_ATTR {
        return hn::Sub(hn::LoadU(d, leaf.place[axis] + k), hn::Set(d, point[axis]));
      });
      for (; bits != 0; bits &= bits - 1) {
        const auto k = static_cast<std::size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
        if (squared[k] >= best) continue;
        best = squared[k];
        index = leaf.index[k];
        found = true;
      }
    }
    do {
      if (count == 0) return found;
      --count;
    } while (waiting[count].squared >= best);
    at = waiting[count].child;
  }
}

}  // namespace rejoin::mesh::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::mesh::detail {

HWY_EXPORT(search);

/// Splits points in halves along the longest side of their box until they fill one leaf at most.
class PointTree::Builder {
 public:
  Builder(PointTree& tree, std::span<const glm::vec3> points) : tree_(tree) {
    points_.reserve(points.size());
    for (const glm::vec3& point : points)
      points_.push_back({point, static_cast<std::uint32_t>(points_.size())});
  }

  void run() { add_node(points_); }

 private:
  struct Entry {
    glm::vec3 place;
    std::uint32_t index;
  };
  using Entries = std::span<Entry>;
  struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};
  };

  static Bounds bounds_of(Entries entries) {
    Bounds bounds;
    for (const Entry& entry : entries) {
      bounds.low = glm::min(bounds.low, entry.place);
      bounds.high = glm::max(bounds.high, entry.place);
    }
    return bounds;
  }

  /// Halves `times` times; leaves but one are full.
  static void split(Entries entries, int times, std::vector<Entries>& parts) {
    if (times == 0 || entries.size() <= kPointsAtOnce) {
      parts.push_back(entries);
      return;
    }
    const Bounds bounds = bounds_of(entries);
    const glm::vec3 size = bounds.high - bounds.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t leaves = (entries.size() + kPointsAtOnce - 1) / kPointsAtOnce;
    const std::size_t middle = (leaves + 1) / 2 * kPointsAtOnce;
    std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(middle), entries.end(),
                     [axis](const Entry& a, const Entry& b) {
                       return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis]
                                                             : a.index < b.index;
                     });
    split(entries.first(middle), times - 1, parts);
    split(entries.subspan(middle), times - 1, parts);
  }

  std::int32_t add_node(Entries entries) {
    const std::size_t at = tree_.nodes_.size();
    tree_.nodes_.emplace_back();
    std::vector<Entries> parts;
    split(entries, 4, parts);
    for (std::size_t k = 0; k < kPointsAtOnce; ++k) {
      const Entries part = k < parts.size() ? parts[k] : Entries();
      const Bounds bounds = bounds_of(part);
      const std::int32_t child = part.empty()                   ? 0
                                 : part.size() <= kPointsAtOnce ? add_leaf(part)
                                                                : add_node(part);
      PointNode& node = tree_.nodes_[at];
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][k] = bounds.low[axis];
        node.high[axis][k] = bounds.high[axis];
      }
      node.child[k] = child;
    }
    return static_cast<std::int32_t>(at);
  }

  std::int32_t add_leaf(Entries entries) {
    PointLeaf leaf;
    for (std::size_t k = 0; k < kPointsAtOnce; ++k) {
      const bool taken = k < entries.size();
      for (int axis = 0; axis < 3; ++axis)
        leaf.place[axis][k] = taken ? entries[k].place[axis] : std::numeric_limits<float>::infinity();
      leaf.index[k] = taken ? entries[k].index : 0;
    }
    tree_.leaves_.push_back(leaf);
    return ~static_cast<std::int32_t>(tree_.leaves_.size() - 1);
  }

  PointTree& tree_;
  std::vector<Entry> points_;
};

PointTree::PointTree(std::span<const glm::vec3> points) {
  if (!points.empty()) Builder(*this, points).run();
}

bool PointTree::nearest(const glm::vec3& point, float& squared, std::uint32_t& index) const {
  if (nodes_.empty()) return false;
  return HWY_DYNAMIC_DISPATCH(search)(nodes_.data(), leaves_.data(), point, squared, index);
}

}  // namespace rejoin::mesh::detail
#endif
