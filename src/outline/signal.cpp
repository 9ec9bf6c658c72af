#include "outline/signal.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::outline {
namespace {

constexpr double kReach = 3.5;  ///< where a Gaussian ends, standard deviations
constexpr std::size_t kLeastSamples = 8;

template <typename Value>
std::vector<Value> convolve(const std::vector<Value>& values, double deviation) {
  if (deviation <= 0.0 || values.empty()) return values;
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kReach * deviation));
  std::vector<double> weights(static_cast<std::size_t>(reach) + 1);
  double sum = 0.0;
  for (std::ptrdiff_t k = 0; k <= reach; ++k) {
    const double x = static_cast<double>(k) / deviation;
    weights[static_cast<std::size_t>(k)] = std::exp(-0.5 * x * x);
    sum += weights[static_cast<std::size_t>(k)] * (k == 0 ? 1.0 : 2.0);
  }
  const auto count = static_cast<std::ptrdiff_t>(values.size());
  // Laid out with its ends repeated, so that the inner loop knows no wrap.
  std::vector<Value> around(values.size() + 2 * static_cast<std::size_t>(reach));
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(around.size()); ++i)
    around[static_cast<std::size_t>(i)] =
        values[static_cast<std::size_t>((((i - reach) % count) + count) % count)];
  std::vector<Value> result(values.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Value* centre = around.data() + i + reach;
    Value total = weights[0] * centre[0];
    for (std::ptrdiff_t k = 1; k <= reach; ++k)
      total += weights[static_cast<std::size_t>(k)] * (centre[k] + centre[-k]);
    result[static_cast<std::size_t>(i)] = total / sum;
  }
  return result;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

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
  const std::size_t count =
      std::max(kLeastSamples, static_cast<std::size_t>(std::lround(lengths.back() / step)));
  ScaleSignal signal;
  signal.step = lengths.back() / static_cast<double>(count);
  signal.points.reserve(count);
  signal.places.reserve(count);
  std::size_t edge = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = signal.step * static_cast<double>(i);
    while (edge + 1 < smoothed.size() && lengths[edge + 1] <= at) ++edge;
    const double length = lengths[edge + 1] - lengths[edge];
    const double share = length > 0.0 ? (at - lengths[edge]) / length : 0.0;
    signal.points.push_back(glm::mix(smoothed[edge], smoothed[(edge + 1) % smoothed.size()], share));
    signal.places.push_back((static_cast<double>(edge) + share) * fine);
  }
  signal.turning = turning_of(signal.points);
  return signal;
}

}  // namespace

std::vector<glm::dvec2> resample(const std::vector<glm::dvec2>& polygon, std::size_t count) {
  const std::vector<double> lengths = arc_lengths(polygon);
  std::vector<glm::dvec2> result;
  result.reserve(count);
  std::size_t edge = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = lengths.back() * static_cast<double>(i) / static_cast<double>(count);
    while (edge + 1 < polygon.size() && lengths[edge + 1] <= at) ++edge;
    const double length = lengths[edge + 1] - lengths[edge];
    result.push_back(glm::mix(polygon[edge], polygon[(edge + 1) % polygon.size()],
                              length > 0.0 ? (at - lengths[edge]) / length : 0.0));
  }
  return result;
}

std::vector<glm::dvec2> smooth(const std::vector<glm::dvec2>& points, double deviation) {
  return convolve(points, deviation);
}

std::vector<double> smooth(const std::vector<double>& values, double deviation) {
  return convolve(values, deviation);
}

std::vector<glm::dvec3> smooth(const std::vector<glm::dvec3>& values, double deviation) {
  return convolve(values, deviation);
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

std::vector<ScaleSignal> scale_space(const Outline& outline, const SignalOptions& options) {
  const double length = perimeter(outline.points);
  const std::size_t fine_count =
      std::max(4 * kLeastSamples, static_cast<std::size_t>(std::lround(2.0 * length / options.step)));
  const std::vector<glm::dvec2> border = resample(outline.points, fine_count);
  const double fine = length / static_cast<double>(fine_count);
  std::vector<ScaleSignal> scales;
  scales.reserve(static_cast<std::size_t>(options.scales));
  double step = options.step;
  for (int k = 0; k < options.scales; ++k) {
    scales.push_back(scale_of(border, fine, step));
    step *= 2.0;
  }
  return scales;
}

}  // namespace rejoin::outline
