#include "outline/outline.hpp"

#include <algorithm>

namespace rejoin::outline {

Planar operator*(const Planar& a, const Planar& b) {
  const double turn = a.flipped ? -b.angle_rad : b.angle_rad;
  return {std::remainder(a.angle_rad + turn, 2.0 * M_PI), a(b.translation), a.flipped != b.flipped};
}

Planar inverse(const Planar& a) {
  Planar back{a.flipped ? a.angle_rad : -a.angle_rad, {}, a.flipped};
  back.translation = -back.direction(a.translation);
  return back;
}

double angle_between(const Planar& a, const Planar& b) {
  if (a.flipped != b.flipped) return M_PI;
  return std::abs(std::remainder(a.angle_rad - b.angle_rad, 2.0 * M_PI));
}

glm::dmat3 matrix(const Planar& pose) {
  return {glm::dvec3(pose.direction({1, 0}), 0), glm::dvec3(pose.direction({0, 1}), 0),
          glm::dvec3(pose.translation, 1)};
}

double signed_area(const std::vector<glm::dvec2>& polygon) {
  if (polygon.empty()) return 0.0;
  // Relative to one corner, so that far from the origin nothing cancels.
  const glm::dvec2 origin = polygon[0];
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i] - origin;
    const glm::dvec2 b = polygon[i + 1] - origin;
    twice += a.x * b.y - a.y * b.x;
  }
  return twice / 2.0;
}

double perimeter(const std::vector<glm::dvec2>& polygon) {
  return arc_lengths(polygon).back();
}

std::vector<double> arc_lengths(const std::vector<glm::dvec2>& polygon) {
  std::vector<double> lengths(polygon.size() + 1, 0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    lengths[i + 1] = lengths[i] + glm::distance(polygon[i], polygon[(i + 1) % polygon.size()]);
  return lengths;
}

glm::dvec2 point_at(const std::vector<glm::dvec2>& polygon, const std::vector<double>& lengths,
                    double distance) {
  const double total = lengths.back();
  double at = std::fmod(distance, total);
  if (at < 0.0) at += total;
  const auto above = std::upper_bound(lengths.begin(), lengths.end(), at);
  const std::size_t i = std::min(static_cast<std::size_t>(above - lengths.begin()), polygon.size()) - 1;
  const double step = lengths[i + 1] - lengths[i];
  const double share = step > 0.0 ? (at - lengths[i]) / step : 0.0;
  return glm::mix(polygon[i], polygon[(i + 1) % polygon.size()], share);
}

}  // namespace rejoin::outline
