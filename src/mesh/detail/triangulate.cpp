#include "mesh/detail/triangulate.hpp"

#include <span>

namespace rejoin::mesh::detail {
namespace {

/// Cuts ears off one polygon.
class EarCutter {
 public:
  EarCutter(const std::vector<glm::dvec3>& points, std::span<const std::uint32_t> corners)
      : points_(points), left_(corners.begin(), corners.end()) {
    // Newell's normal: right for every simple polygon, flat or nearly so.
    for (std::size_t i = 0; i < left_.size(); ++i) {
      normal_ += glm::cross(point(i) - point(0), point(i + 1) - point(0));
    }
  }

  void cut(std::vector<glm::uvec3>& faces) {
    while (left_.size() > 3) {
      const std::size_t ear = best_ear();
      faces.emplace_back(corner(ear + left_.size() - 1), corner(ear), corner(ear + 1));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    faces.emplace_back(left_[0], left_[1], left_[2]);
  }

 private:
  std::uint32_t corner(std::size_t i) const { return left_[i % left_.size()]; }
  const glm::dvec3& point(std::size_t i) const { return points_[corner(i)]; }

  /// Signed area (times two, times the normal's length) of a triangle seen along the normal.
  double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
    return glm::dot(normal_, glm::cross(b - a, c - a));
  }

  bool is_ear(std::size_t i) const {
    const std::size_t count = left_.size();
    const glm::dvec3& a = point(i + count - 1);
    const glm::dvec3& b = point(i);
    const glm::dvec3& c = point(i + 1);
    if (turn(a, b, c) <= 0) return false;
    for (std::size_t k = i + 2; k + 1 < i + count; ++k) {
      const glm::dvec3& p = point(k);
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  /// The ear with the shortest cut, so that a quad gets its short diagonal; corner 1 where a polygon has no
  /// ear (a fan then).
  std::size_t best_ear() const {
    std::size_t best = left_.size();
    double shortest = 0;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const glm::dvec3 cut = point(i + left_.size() - 1) - point(i + 1);
      const double length = glm::dot(cut, cut);
      if ((best == left_.size() || length < shortest) && is_ear(i)) {
        best = i;
        shortest = length;
      }
    }
    return best == left_.size() ? 1 : best;
  }

  const std::vector<glm::dvec3>& points_;
  std::vector<std::uint32_t> left_;
  glm::dvec3 normal_{0.0};
};

}  // namespace

std::vector<glm::uvec3> triangulate(const Soup& soup) {
  std::vector<glm::uvec3> faces;
  faces.reserve(soup.sizes.size());
  std::size_t first = 0;
  for (const std::uint32_t size : soup.sizes) {
    const std::span corners(soup.corners.data() + first, size);
    first += size;
    if (size == 3) {
      faces.emplace_back(corners[0], corners[1], corners[2]);
    } else if (size > 3) {
      EarCutter(soup.points, corners).cut(faces);
    }
  }
  return faces;
}

}  // namespace rejoin::mesh::detail
