#include "mesh/detail/triangulate.hpp"

#include <algorithm>
#include <queue>
#include <span>
#include <tuple>

#include "mesh/detail/corner_grid.hpp"

namespace rejoin::mesh::detail {
namespace {

using Corners = std::span<const std::uint32_t>;

/// Newell's normal: right for every simple polygon, flat or nearly so.
glm::dvec3 normal_of(const std::vector<glm::dvec3>& points, Corners corners) {
  const glm::dvec3& first = points[corners[0]];
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(points[corners[i]] - first, points[corners[(i + 1) % corners.size()]] - first);
  return normal;
}

/// Places seen along the normal, as turn() does.
std::vector<glm::dvec2> flattened(const std::vector<glm::dvec3>& points, Corners corners,
                                  const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int least = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  glm::dvec3 x(0.0);
  x[least] = 1.0;
  glm::dvec3 y = x;
  if (normal != glm::dvec3(0.0)) {
    const glm::dvec3 z = glm::normalize(normal / std::max({size.x, size.y, size.z}));
    x = glm::normalize(glm::cross(x, z));
    y = glm::cross(z, x);
  }
  std::vector<glm::dvec2> places;
  places.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const glm::dvec3 from_first = points[corner] - points[corners[0]];
    places.emplace_back(glm::dot(from_first, x), glm::dot(from_first, y));
  }
  return places;
}

/// Cuts ears off one polygon, always the one with the shortest cut, so that a quad gets its short diagonal.
class EarCutter {
 public:
  EarCutter(const std::vector<glm::dvec3>& points, Corners corners)
      : points_(points),
        corners_(corners),
        left_(corners.size()),
        before_(left_),
        after_(left_),
        normal_(normal_of(points, corners)),
        states_(left_, 0),
        hollow_(flattened(points, corners, normal_)),
        stopped_by_(left_) {
    for (std::size_t i = 0; i < left_; ++i) {
      after_[i] = i + 1 < left_ ? i + 1 : 0;
      before_[i] = i > 0 ? i - 1 : left_ - 1;
    }
    for (std::size_t i = 0; i < left_; ++i) look_at(i);
  }

  void cut(std::vector<glm::uvec3>& faces) {
    while (left_ > 3) {
      const std::size_t ear = shortest_ear();
      add_face(ear, faces);
      remove(ear);
    }
    add_face(after_[first_], faces);
  }

 private:
  /// A corner that may be cut off; nothing if the corner has changed since.
  struct Candidate {
    double length;  ///< of the cut, squared
    std::size_t at;
    std::uint32_t state;
    bool operator<(const Candidate& other) const {  // the shortest first, then the one that comes first
      return std::tie(other.length, other.at) < std::tie(length, at);
    }
  };

  const glm::dvec3& point(std::size_t i) const { return points_[corners_[i]]; }

  void add_face(std::size_t ear, std::vector<glm::uvec3>& faces) const {
    faces.emplace_back(corners_[before_[ear]], corners_[ear], corners_[after_[ear]]);
  }

  /// Signed area (times two, times the normal's length) of a triangle seen along the normal.
  double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
    return glm::dot(normal_, glm::cross(b - a, c - a));
  }

  /// Files a corner among those that may be cut or those that the border turns in at, after its neighbours changed.
  void look_at(std::size_t i) {
    ++states_[i];
    if (turn(point(before_[i]), point(i), point(after_[i])) > 0) {
      leave_hollow(i);
      offer(i);
    } else if (!hollow_.has(i)) {
      hollow_.add(i);
    }
  }

  void offer(std::size_t i) {
    const glm::dvec3 cut = point(before_[i]) - point(after_[i]);
    candidates_.push({glm::dot(cut, cut), i, states_[i]});
  }

  /// The corner stops no ear any longer.
  void leave_hollow(std::size_t i) {
    if (!hollow_.has(i)) return;
    hollow_.remove(i);
    for (const Candidate& stopped : stopped_by_[i])
      if (states_[stopped.at] == stopped.state) candidates_.push(stopped);
    stopped_by_[i].clear();
  }

  /// A corner where the border turns in that lies in the triangle to be cut off; CornerGrid::kNone: it is an ear.
  std::size_t stopper(std::size_t i) const {
    const glm::dvec3& a = point(before_[i]);
    const glm::dvec3& b = point(i);
    const glm::dvec3& c = point(after_[i]);
    const CornerGrid::Triangle triangle{hollow_.place(before_[i]), hollow_.place(i),
                                        hollow_.place(after_[i])};
    return hollow_.find(triangle, [&](std::size_t k) {
      if (k == before_[i] || k == after_[i]) return false;
      const glm::dvec3& p = point(k);
      return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }

  /// The second corner left where a polygon has no ear (a fan then).
  std::size_t shortest_ear() {
    while (!candidates_.empty()) {
      const Candidate best = candidates_.top();
      candidates_.pop();
      if (states_[best.at] != best.state) continue;
      const std::size_t in_the_way = stopper(best.at);
      if (in_the_way == CornerGrid::kNone) return best.at;
      stopped_by_[in_the_way].push_back(best);
    }
    return after_[first_];
  }

  void remove(std::size_t i) {
    ++states_[i];
    leave_hollow(i);
    const std::size_t before = before_[i];
    const std::size_t after = after_[i];
    after_[before] = after;
    before_[after] = before;
    if (i == first_) first_ = after;
    --left_;
    look_at(before);
    look_at(after);
  }

  const std::vector<glm::dvec3>& points_;
  Corners corners_;
  std::size_t left_;                 ///< corners
  std::vector<std::size_t> before_;  ///< each corner's neighbours among those left
  std::vector<std::size_t> after_;
  std::size_t first_ = 0;
  glm::dvec3 normal_;
  std::vector<std::uint32_t> states_;  ///< how often a corner's neighbours have changed
  std::priority_queue<Candidate> candidates_;
  CornerGrid hollow_;                               ///< corners where the border turns in
  std::vector<std::vector<Candidate>> stopped_by_;  ///< what cannot be cut because of each corner
};

}  // namespace

std::vector<glm::uvec3> triangulate(const Soup& soup) {
  std::vector<glm::uvec3> faces;
  faces.reserve(soup.sizes.size());
  std::size_t first = 0;
  for (const std::uint32_t size : soup.sizes) {
    const Corners corners(soup.corners.data() + first, size);
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
