#include "outline/outline.hpp"

#include <algorithm>
#include <cmath>

#include "core/median.hpp"

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

bool any_of_pixels(const std::vector<Piece>& pieces) {
  return std::any_of(pieces.begin(), pieces.end(),
                     [](const Piece& piece) { return piece.outline.of_pixels; });
}

JoinCandidate exchanged(const JoinCandidate& join, double perimeter_a, double perimeter_b) {
  const auto on_border = [](double place, double perimeter) {
    return place - std::floor(place / perimeter) * perimeter;
  };
  const Boundary& met = join.boundary;
  const Boundary boundary{
      .begin_a = join.pose.flipped ? met.begin_b : on_border(met.begin_b - met.length_b(), perimeter_b),
      .begin_b = join.pose.flipped ? met.begin_a : on_border(met.begin_a + met.length_a(), perimeter_a),
      .length = met.length,
      .hole_a = met.hole_b,
      .hole_b = met.hole_a,
      .longer_b = -met.longer_b};
  return {inverse(join.pose), join.score, boundary};
}

double angle_between(const Planar& a, const Planar& b) {
  if (a.flipped != b.flipped) return M_PI;
  return std::abs(std::remainder(a.angle_rad - b.angle_rad, 2.0 * M_PI));
}

Planar superposed(const std::vector<glm::dvec2>& from, const std::vector<glm::dvec2>& to) {
  glm::dvec2 from_mean(0.0);
  glm::dvec2 to_mean(0.0);
  for (std::size_t k = 0; k < from.size(); ++k) {
    from_mean += from[k];
    to_mean += to[k];
  }
  from_mean /= static_cast<double>(from.size());
  to_mean /= static_cast<double>(to.size());
  double cosine = 0.0;
  double sine = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    cosine += glm::dot(from[k] - from_mean, to[k] - to_mean);
    sine += cross(from[k] - from_mean, to[k] - to_mean);
  }
  Planar pose{std::atan2(sine, cosine), {}, false};
  pose.translation = to_mean - pose.direction(from_mean);
  return pose;
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
    twice += cross(a, b);
  }
  return twice / 2.0;
}

double perimeter(const std::vector<glm::dvec2>& polygon) {
  return arc_lengths(polygon).back();
}

double median_perimeter(const std::vector<Piece>& pieces) {
  std::vector<double> perimeters;
  perimeters.reserve(pieces.size());
  for (const Piece& piece : pieces) perimeters.push_back(perimeter(piece.outline.points));
  return median(perimeters);
}

std::vector<std::size_t> long_borders(const Outline& outline, double least) {
  std::vector<std::size_t> borders{0};
  for (std::size_t hole = 1; hole <= outline.holes.size(); ++hole)
    if (perimeter(border_of(outline, hole)) >= least) borders.push_back(hole);
  return borders;
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
  return point_at(polygon, EdgePlace{i, step > 0.0 ? (at - lengths[i]) / step : 0.0});
}

std::vector<EdgePlace> even_places(const std::vector<double>& lengths, std::size_t count) {
  std::vector<EdgePlace> places;
  places.reserve(count);
  std::size_t edge = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = lengths.back() * static_cast<double>(i) / static_cast<double>(count);
    while (edge + 2 < lengths.size() && lengths[edge + 1] <= at) ++edge;
    const double length = lengths[edge + 1] - lengths[edge];
    places.push_back({edge, length > 0.0 ? (at - lengths[edge]) / length : 0.0});
  }
  return places;
}

glm::dvec2 point_at(const std::vector<glm::dvec2>& polygon, const EdgePlace& place) {
  return glm::mix(polygon[place.edge], polygon[(place.edge + 1) % polygon.size()], place.share);
}

}  // namespace rejoin::outline
