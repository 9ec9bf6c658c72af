#include "outline/signal.hpp"

#include <algorithm>
#include <cmath>

#include "core/smooth.hpp"

namespace rejoin::outline {
namespace {

constexpr std::size_t kShortest = 8;
constexpr std::size_t kFewestPoints = 16;
constexpr double kMostPoints = 1e6;  // of a border in another unit than that of the step

/// Angle from the edge before each point to the edge after it.
std::vector<float> turning_of(const std::vector<glm::dvec2>& points) {
  const std::size_t count = points.size();
  std::vector<float> turning(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 before = points[i] - points[(i + count - 1) % count];
    const glm::dvec2 after = points[(i + 1) % count] - points[i];
    turning[i] = static_cast<float>(std::atan2(cross(before, after), glm::dot(before, after)));
  }
  return turning;
}

/// One scale of a border that is sampled `fine` apart.
ScaleSignal scale_of(const std::vector<glm::dvec2>& border, double fine, double step) {
  const std::vector<glm::dvec2> smoothed = smooth(border, step / fine);
  const std::vector<double> lengths = arc_lengths(smoothed);
  const std::size_t count = std::max(kShortest, static_cast<std::size_t>(std::lround(lengths.back() / step)));
  ScaleSignal signal;
  signal.step = lengths.back() / static_cast<double>(count);
  signal.points.reserve(count);
  signal.places.reserve(count);
  for (const EdgePlace& place : even_places(lengths, count)) {
    signal.points.push_back(point_at(smoothed, place));
    signal.places.push_back((static_cast<double>(place.edge) + place.share) * fine);
  }
  signal.turning = turning_of(signal.points);
  return signal;
}

}  // namespace

std::vector<glm::dvec2> resample(const std::vector<glm::dvec2>& polygon, std::size_t count) {
  std::vector<glm::dvec2> result;
  result.reserve(count);
  for (const EdgePlace& place : even_places(arc_lengths(polygon), count))
    result.push_back(point_at(polygon, place));
  return result;
}

std::vector<glm::dvec2> resample_by(const std::vector<glm::dvec2>& polygon, double step) {
  const double wanted = std::min(perimeter(polygon) / step, kMostPoints);
  return resample(polygon, std::max(kFewestPoints, static_cast<std::size_t>(std::lround(wanted))));
}

std::vector<double> curvature(const std::vector<glm::dvec2>& points) {
  const std::size_t count = points.size();
  std::vector<double> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 before = points[(i + count - 1) % count];
    const glm::dvec2 after = points[(i + 1) % count];
    const glm::dvec2 first = (after - before) / 2.0;
    const glm::dvec2 second = after - 2.0 * points[i] + before;
    const double speed = glm::length(first);
    result[i] = speed > 0.0 ? cross(first, second) / (speed * speed * speed) : 0.0;
  }
  return result;
}

std::vector<ScaleSignal> scale_space(const std::vector<glm::dvec2>& border, const SignalOptions& options) {
  const double length = perimeter(border);
  const std::size_t fine_count =
      std::max(4 * kShortest, static_cast<std::size_t>(std::lround(2.0 * length / options.step)));
  const std::vector<glm::dvec2> even = resample(border, fine_count);
  const double fine = length / static_cast<double>(fine_count);
  std::vector<ScaleSignal> scales;
  scales.reserve(static_cast<std::size_t>(options.scales));
  double step = options.step;
  for (int k = 0; k < options.scales; ++k) {
    scales.push_back(scale_of(even, fine, step));
    step *= 2.0;
  }
  return scales;
}

}  // namespace rejoin::outline
