#include "mesh/detail/sheet.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::mesh::detail {
namespace {

/// Triangle turned so that `corner` comes first.
glm::uvec3 from_corner(const glm::uvec3& t, int corner) {
  return {t[corner], t[(corner + 1) % 3], t[(corner + 2) % 3]};
}

int corner_of(const glm::uvec3& t, std::uint32_t point) {
  return t.x == point ? 0 : t.y == point ? 1 : 2;
}

}  // namespace

Sheet::Sheet(const std::vector<glm::vec3>& points, const std::vector<glm::vec3>& axes)
    : points_(points), axes_(axes), around_(points.size()) {}

bool Sheet::has_edge(std::uint32_t from, std::uint32_t to) const {
  return std::any_of(around_[from].begin(), around_[from].end(), [&](std::uint32_t f) {
    const glm::uvec3& face = faces_[f];
    return face[(corner_of(face, from) + 1) % 3] == to;
  });
}

void Sheet::open_edges(std::uint32_t from, std::vector<std::uint32_t>& ends) const {
  ends.clear();
  for (const std::uint32_t f : around_[from]) {
    const std::uint32_t before = faces_[f][(corner_of(faces_[f], from) + 2) % 3];
    if (!has_edge(from, before)) ends.push_back(before);
  }
}

glm::vec3 Sheet::cross_of(const glm::uvec3& t) const {
  return glm::cross(points_[t.y] - points_[t.x], points_[t.z] - points_[t.x]);
}

/// Whether the triangle would lie back on a face that it shares an edge with.
bool Sheet::folds(const glm::uvec3& triangle) const {
  constexpr float kSharpest = -0.6F;  // faces may turn by 127 degrees: an edge of 53
  const glm::vec3 cross = cross_of(triangle);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = triangle[k];
    const std::uint32_t b = triangle[(k + 1) % 3];
    for (const std::uint32_t f : around_[b]) {
      if (faces_[f][(corner_of(faces_[f], b) + 1) % 3] != a) continue;
      const glm::vec3 other = cross_of(faces_[f]);
      if (glm::dot(cross, other) < kSharpest * glm::length(cross) * glm::length(other)) return true;
    }
  }
  return false;
}

/// Whether the triangle overlaps a face at the same corner, seen along the point's axis.
bool Sheet::overlaps(const glm::uvec3& triangle, int corner) const {
  constexpr float kSlack = 0.02F;  // sine: what rounding and the turning down of a bent star may overlap
  const glm::uvec3 t = from_corner(triangle, corner);
  const glm::vec3& axis = axes_[t.x];
  const auto flat = [&](std::uint32_t point) {
    const glm::vec3 step = points_[point] - points_[t.x];
    const glm::vec3 projected = step - glm::dot(step, axis) * axis;
    const float length = glm::length(projected);
    return length > 0 ? projected / length : projected;
  };
  const auto turn = [&](const glm::vec3& a, const glm::vec3& b) { return glm::dot(axis, glm::cross(a, b)); };
  const auto inside = [&](const glm::vec3& p, const glm::vec3& a, const glm::vec3& b) {
    return turn(a, p) > kSlack && turn(p, b) > kSlack;
  };
  const glm::vec3 a = flat(t.y);
  const glm::vec3 b = flat(t.z);
  const glm::vec3 middle = a + b;
  for (const std::uint32_t f : around_[t.x]) {
    const glm::uvec3 other = from_corner(faces_[f], corner_of(faces_[f], t.x));
    const glm::vec3 c = flat(other.y);
    const glm::vec3 d = flat(other.z);
    if (inside(c, a, b) || inside(d, a, b) || inside(a, c, d) || inside(b, c, d)) return true;
    if (inside(middle, c, d) || inside(c + d, a, b)) return true;
  }
  return false;
}

bool Sheet::fits(const glm::uvec3& triangle) const {
  for (int k = 0; k < 3; ++k) {
    if (has_edge(triangle[k], triangle[(k + 1) % 3])) return false;
  }
  return !folds(triangle);
}

void Sheet::insert(const glm::uvec3& triangle) {
  for (int k = 0; k < 3; ++k) around_[triangle[k]].push_back(static_cast<std::uint32_t>(faces_.size()));
  faces_.push_back(triangle);
}

bool Sheet::add(const glm::uvec3& triangle) {
  if (!fits(triangle)) return false;
  for (int k = 0; k < 3; ++k) {
    if (overlaps(triangle, k)) return false;
  }
  insert(triangle);
  return true;
}

bool Sheet::close(const glm::uvec3& triangle) {
  if (!fits(triangle)) return false;
  insert(triangle);
  return true;
}

}  // namespace rejoin::mesh::detail
