#include "outline/congruence.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "core/median.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

constexpr double kSameArea = 0.01;
constexpr double kMostOfLength = 1.0 / 1000.0;
/// This share of the places must meet: print at a border may be bitten out of one scan.
constexpr double kMeeting = 0.95;
/// Places that are compared; noise makes borders longer, so that equal shares of two do not quite meet.
constexpr std::size_t kPlaces = 128;
/// Borders of one piece correlate by at least this much.
constexpr double kAlike = 0.98;
constexpr int kRounds = 8;  // of near places and motion

using Points = std::vector<glm::dvec2>;

/// The border's nearest place to a point.
glm::dvec2 nearest_on(const Points& polygon, const glm::dvec2& point) {
  double least = std::numeric_limits<double>::infinity();
  glm::dvec2 best(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& from = polygon[i];
    const glm::dvec2 edge = polygon[i + 1 < polygon.size() ? i + 1 : 0] - from;
    const double squared = glm::dot(edge, edge);
    const double share = squared > 0.0 ? std::clamp(glm::dot(point - from, edge) / squared, 0.0, 1.0) : 0.0;
    const glm::dvec2 off = from + share * edge - point;
    if (glm::dot(off, off) >= least) continue;
    least = glm::dot(off, off);
    best = from + share * edge;
  }
  return best;
}

std::vector<std::complex<double>> centred(const Points& points) {
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
  double squares = 0.0;
  for (const glm::dvec2& p : points) squares += glm::dot(p - mean, p - mean);
  std::vector<std::complex<double>> result;
  result.reserve(points.size());
  for (const glm::dvec2& p : points)
    result.emplace_back((p.x - mean.x) / std::sqrt(squares), (p.y - mean.y) / std::sqrt(squares));
  return result;
}

/// How well b's places, so many on from a's, lie on these after the best motion, 1 where they meet; for every number.
std::vector<double> likeness(const Points& a, const Points& b) {
  const auto from_a = centred(a);
  const auto from_b = centred(b);
  std::vector<double> result;
  result.reserve(kPlaces);
  for (std::size_t shift = 0; shift < kPlaces; ++shift) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < kPlaces; ++i) sum += std::conj(from_a[i]) * from_b[(i + shift) % kPlaces];
    result.push_back(std::abs(sum));
  }
  return result;
}

double median_edge(const Points& polygon) {
  const std::vector<double> lengths = arc_lengths(polygon);
  std::vector<double> edges;
  edges.reserve(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) edges.push_back(lengths[i + 1] - lengths[i]);
  return median(edges);
}

/// Distance that all but few of the places keep from a border when they are moved onto it.
/// \param onto  where each of them lies at first
double settled_distance(const Points& places, Points onto, const Points& border) {
  std::vector<double> distances(places.size());
  for (int round = 0; round < kRounds; ++round) {
    const Planar pose = superposed(places, onto);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::dvec2 moved = pose(places[i]);
      onto[i] = nearest_on(border, moved);
      distances[i] = glm::distance(onto[i], moved);
    }
  }
  return quantile(distances, kMeeting);
}

}  // namespace

bool congruent(const Outline& a, const Outline& b) {
  const double area_a = signed_area(a.points);
  const double area_b = signed_area(b.points);
  if (std::abs(area_a - area_b) > kSameArea * std::max(area_a, area_b)) return false;
  const double length = std::min(perimeter(a.points), perimeter(b.points));
  const double most =
      std::min(std::max(median_edge(a.points), median_edge(b.points)), kMostOfLength * length);
  const Points places = resample(a.points, kPlaces);
  const Points others = resample(b.points, kPlaces);
  const std::vector<double> alike = likeness(places, others);
  for (std::size_t shift = 0; shift < kPlaces; ++shift) {
    const double before = alike[(shift + kPlaces - 1) % kPlaces];
    if (alike[shift] < kAlike || alike[shift] < before || alike[shift] < alike[(shift + 1) % kPlaces])
      continue;
    Points onto = others;
    std::rotate(onto.begin(), onto.begin() + static_cast<std::ptrdiff_t>(shift), onto.end());
    if (settled_distance(places, std::move(onto), b.points) <= most) return true;
  }
  return false;
}

Outline turned_over(const Outline& a) {
  Outline other;
  other.points.assign(a.points.rbegin(), a.points.rend());
  for (glm::dvec2& p : other.points) p.y = -p.y;
  return other;
}

}  // namespace rejoin::outline
