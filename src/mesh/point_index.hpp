/// Neighbours of points.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace rejoin::mesh {

/// Looks for points among those that it keeps a copy of.  Const members may be called from several threads.
class PointIndex {
 public:
  explicit PointIndex(std::span<const glm::vec3> points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  /// Indices of all points within `radius`, in ascending order of index.
  void within(const glm::vec3& point, float radius, std::vector<std::uint32_t>& found) const;

  /// Nearest point and its distance; nullopt if there are no points.
  std::optional<std::pair<std::uint32_t, float>> nearest(const glm::vec3& point) const;

  /// Nearest point that is closer than `radius`, and its distance.  The smaller the radius, the faster.
  std::optional<std::pair<std::uint32_t, float>> nearest_within(const glm::vec3& point, float radius) const;

  /// The answer to an earlier look, and how far from its place it stays the answer.
  struct Known {
    glm::vec3 place{std::numeric_limits<float>::quiet_NaN()};
    float room = 0;  ///< without a nearest point: distance up to which there is none
    std::optional<std::uint32_t> nearest;
  };

  /// The same, for a point that moves little from look to look: most need no search then.
  /// \param known  of the point's last look, and only of this index
  std::optional<std::pair<std::uint32_t, float>> nearest_within(const glm::vec3& point, float radius,
                                                                Known& known) const;

  /// The k nearest, nearest first.
  void nearest(const glm::vec3& point, std::size_t k, std::vector<std::uint32_t>& found) const;

  /// All indices, those of points near each other mostly near each other: whoever asks for each point's neighbours in this order
  /// finds most of them in the processor's caches, however the points themselves are ordered.
  const std::vector<std::uint32_t>& by_place() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rejoin::mesh
