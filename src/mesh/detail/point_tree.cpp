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

/// Squared distances of points or boxes by `distance(tag, first lane, axis)`.
template <typename Distance>
HWY_INLINE Vector squares(std::size_t first, const Distance& distance) {
  const Tag d;
  const Vector x = distance(d, first, 0);
  const Vector y = distance(d, first, 1);
  const Vector z = distance(d, first, 2);
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

HWY_INLINE unsigned bits_of(hn::Mask<Tag> mask) {
  std::uint8_t byte[8] = {};
  hn::StoreMaskBits(Tag(), mask, byte);
  return static_cast<unsigned>(byte[0]) | static_cast<unsigned>(byte[1]) << 8U;
}

/// \tparam kOthers  whether `others` is asked for
template <bool kOthers>
HWY_INLINE bool search_any(const PointNode* nodes, const PointLeaf* leaves, const glm::vec3& point,
                           float& best, std::uint32_t& index, float& others) {
  const Tag d;
  const Vector nothing = hn::Set(d, std::numeric_limits<float>::infinity());
  Vector passed = nothing;  // all that is left aside, but for what waits
  std::array<Waiting, kMostWaiting> waiting;
  std::size_t count = 0;
  std::int32_t at = 0;
  bool found = false;
  alignas(64) float squared[kPointsAtOnce];
  while (true) {
    if (at >= 0) {
      const PointNode& node = nodes[at];
      unsigned bits = 0;
      for (std::size_t first = 0; first < kPointsAtOnce; first += hn::Lanes(d)) {
        const Vector sum = squares(first, [&](const Tag d, std::size_t k, int axis) HWY_ATTR {
          const Vector p = hn::Set(d, point[axis]);
          return hn::Max(hn::Zero(d), hn::Max(hn::Sub(hn::LoadU(d, node.low[axis] + k), p),
                                              hn::Sub(p, hn::LoadU(d, node.high[axis] + k))));
        });
        hn::Store(sum, d, squared + first);
        const auto near = hn::Lt(sum, hn::Set(d, best));
        bits |= bits_of(near) << first;
        if constexpr (kOthers) passed = hn::Min(passed, hn::IfThenElse(near, nothing, sum));
      }
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
      Vector sums[kPointsAtOnce / hn::MaxLanes(d)];
      Vector least = hn::Set(d, best);
      for (std::size_t first = 0; first < kPointsAtOnce; first += hn::Lanes(d)) {
        Vector& sum = sums[first / hn::Lanes(d)];
        sum = squares(first, [&](const Tag d, std::size_t k, int axis) HWY_ATTR {
          return hn::Sub(hn::LoadU(d, leaf.place[axis] + k), hn::Set(d, point[axis]));
        });
        least = hn::Min(least, sum);
      }
      least = hn::MinOfLanes(d, least);
      const bool nearer = hn::GetLane(least) < best;
      if (nearer) {
        if (kOthers && found) passed = hn::Min(passed, hn::Set(d, best));
        best = hn::GetLane(least);
        unsigned bits = 0;
        for (std::size_t first = 0; first < kPointsAtOnce; first += hn::Lanes(d)) {
          bits |= bits_of(hn::Eq(sums[first / hn::Lanes(d)], least)) << first;
        }
        const auto lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
        index = leaf.index[lane];
        found = true;
        if constexpr (kOthers) {
          for (std::size_t first = 0; first < kPointsAtOnce; first += hn::Lanes(d)) {
            const Vector lanes = hn::Iota(d, static_cast<float>(first));
            const auto taken = hn::Eq(lanes, hn::Set(d, static_cast<float>(lane)));
            passed = hn::Min(passed, hn::IfThenElse(taken, nothing, sums[first / hn::Lanes(d)]));
          }
        }
      } else if constexpr (kOthers) {
        for (const Vector& sum : sums) passed = hn::Min(passed, sum);
      }
    }
    while (true) {
      if (count == 0) {
        if constexpr (kOthers) others = hn::GetLane(hn::MinOfLanes(d, passed));
        return found;
      }
      --count;
      if (waiting[count].squared < best) break;
      if constexpr (kOthers) passed = hn::Min(passed, hn::Set(d, waiting[count].squared));
    }
    at = waiting[count].child;
  }
}

bool search(const PointNode* nodes, const PointLeaf* leaves, const glm::vec3& point, float& best,
            std::uint32_t& index) {
  float others = 0;
  return search_any<false>(nodes, leaves, point, best, index, others);
}

bool search_with_others(const PointNode* nodes, const PointLeaf* leaves, const glm::vec3& point, float& best,
                        std::uint32_t& index, float& others) {
  return search_any<true>(nodes, leaves, point, best, index, others);
}

}  // namespace rejoin::mesh::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::mesh::detail {

HWY_EXPORT(search);
HWY_EXPORT(search_with_others);

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

bool PointTree::nearest(const glm::vec3& point, float& squared, std::uint32_t& index, float& others) const {
  others = std::numeric_limits<float>::infinity();
  if (nodes_.empty()) return false;
  return HWY_DYNAMIC_DISPATCH(search_with_others)(nodes_.data(), leaves_.data(), point, squared, index,
                                                  others);
}

}  // namespace rejoin::mesh::detail
#endif
