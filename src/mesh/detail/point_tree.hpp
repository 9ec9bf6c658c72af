/// The nearest of many points, many at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::mesh::detail {

inline constexpr std::size_t kPointsAtOnce = 16;

/// Boxes around what lies below each child.  A child >= 0 is a node, one below 0 the leaf ~child; boxes without a child are empty.
struct PointNode {
  alignas(64) float low[3][kPointsAtOnce];
  alignas(64) float high[3][kPointsAtOnce];
  std::int32_t child[kPointsAtOnce];
};

/// Points; places that are not taken hold infinity.
struct PointLeaf {
  alignas(64) float place[3][kPointsAtOnce];
  std::uint32_t index[kPointsAtOnce];
};

/// Hierarchy of boxes around groups of points, searched in SIMD: what the alignment of two fragments does most.  A k-d tree
/// looks at one coordinate or one point at a time.  Const members may be called from several threads.
class PointTree {
 public:
  PointTree() = default;
  explicit PointTree(std::span<const glm::vec3> points);

  /// Looks for the nearest point that is closer than the root of `squared`; puts its index and squared distance in place.
  /// \return whether there is one
  bool nearest(const glm::vec3& point, float& squared, std::uint32_t& index) const;

  /// \param others  becomes a squared distance below which none of the other points lies, but for rounding
  bool nearest(const glm::vec3& point, float& squared, std::uint32_t& index, float& others) const;

 private:
  class Builder;

  std::vector<PointNode> nodes_;  ///< the root first
  std::vector<PointLeaf> leaves_;
};

}  // namespace rejoin::mesh::detail
