#include "mesh/detail/fill_holes.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kMostEdges = 12;
constexpr double kWidest = 5;  ///< longest edge put across a hole, in spacings

using Loop = std::vector<std::uint32_t>;

class HoleFiller {
 public:
  HoleFiller(const Mesh& cloud, const Neighbourhoods& around, Sheet& sheet)
      : cloud_(cloud), axes_(around.axes), widest_(kWidest * around.spacing), sheet_(sheet) {}

  void fill() {
    std::vector<std::uint32_t> ends;
    for (std::uint32_t start = 0; start < cloud_.vertices.size(); ++start) {
      sheet_.open_edges(start, ends);
      const std::vector<std::uint32_t> first_steps = ends;
      for (const std::uint32_t second : first_steps) {
        // Filling one loop may have closed the next one's edges.
        if (sheet_.has_edge(start, second)) continue;
        Loop loop{start, second};
        if (trace(loop)) close(loop);
      }
    }
  }

 private:
  /// Angle from a to b about the axis, in (0, 2 pi].
  static double turn(const glm::vec3& axis, const glm::vec3& a, const glm::vec3& b) {
    const double angle =
        std::atan2(glm::dot(axis, glm::cross(a, b)), glm::dot(a, b) - glm::dot(axis, a) * glm::dot(axis, b));
    return angle > 0 ? angle : angle + 2 * std::numbers::pi;
  }

  /// Follows the boundary from the first two points until it closes; false if it is too long for a small hole.
  bool trace(Loop& loop) const {
    std::vector<std::uint32_t> ends;
    while (loop.size() <= kMostEdges) {
      const std::uint32_t at = loop.back();
      const glm::vec3 back = cloud_.vertices[loop[loop.size() - 2]] - cloud_.vertices[at];
      sheet_.open_edges(at, ends);
      // Where several holes meet in a point, the next edge is the one across the empty sector.
      std::uint32_t next = at;
      double least = std::numeric_limits<double>::infinity();
      for (const std::uint32_t end : ends) {
        const double angle = turn(axes_[at], cloud_.vertices[end] - cloud_.vertices[at], back);
        if (angle >= least) continue;
        least = angle;
        next = end;
      }
      if (next == at) return false;
      if (next == loop.front()) return loop.size() >= 3;
      loop.push_back(next);
    }
    return false;
  }

  bool follows_normals(const glm::uvec3& t) const {
    const glm::vec3& a = cloud_.vertices[t.x];
    const glm::vec3 cross = glm::cross(cloud_.vertices[t.y] - a, cloud_.vertices[t.z] - a);
    return glm::dot(cross, cloud_.normals[t.x] + cloud_.normals[t.y] + cloud_.normals[t.z]) > 0;
  }

  /// Cuts ears off the loop, the shortest cut first, as long as they fit.
  void close(Loop loop) {
    while (loop.size() >= 3) {
      const std::size_t count = loop.size();
      std::size_t best = count;
      double shortest = widest_;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t before = loop[(i + count - 1) % count];
        const std::uint32_t after = loop[(i + 1) % count];
        const double cut = glm::distance(cloud_.vertices[before], cloud_.vertices[after]);
        if (cut >= shortest || before == after || !follows_normals({before, loop[i], after})) continue;
        if (count > 3 && (sheet_.has_edge(before, after) || sheet_.has_edge(after, before))) continue;
        shortest = cut;
        best = i;
      }
      if (best == count) return;
      if (!sheet_.close({loop[(best + count - 1) % count], loop[best], loop[(best + 1) % count]})) return;
      if (count == 3) return;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
    }
  }

  const Mesh& cloud_;
  const std::vector<glm::vec3>& axes_;
  double widest_;
  Sheet& sheet_;
};

}  // namespace

void fill_holes(const Mesh& cloud, const Neighbourhoods& around, Sheet& sheet) {
  HoleFiller(cloud, around, sheet).fill();
}

}  // namespace rejoin::mesh::detail
