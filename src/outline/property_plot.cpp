#include "outline/property_plot.hpp"

#include <algorithm>

namespace rejoin::outline {
namespace {

constexpr std::size_t kFewestPoints = 16;
// A feature turns at least this share of the mean turn.
constexpr float kFeatureShare = 1.0F;

/// Turn of the border over `reach` samples at each sample.
std::vector<float> turns(const std::vector<glm::dvec2>& points, std::size_t reach) {
  const std::size_t count = points.size();
  std::vector<float> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 before = points[i] - points[(i + count - reach) % count];
    const glm::dvec2 after = points[(i + reach) % count] - points[i];
    const double cross = before.x * after.y - before.y * after.x;
    out[i] = static_cast<float>(std::atan2(cross, glm::dot(before, after)));
  }
  return out;
}

std::vector<std::size_t> extremes(const std::vector<float>& turn) {
  const std::size_t count = turn.size();
  double mean = 0.0;
  for (const float value : turn) mean += std::abs(value);
  const auto least = static_cast<float>(kFeatureShare * mean / static_cast<double>(count));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < count; ++i) {
    const float here = turn[i];
    const float before = turn[(i + count - 1) % count];
    const float after = turn[(i + 1) % count];
    const bool high = here > 0 && here >= before && here > after;
    const bool low = here < 0 && here <= before && here < after;
    if ((high || low) && std::abs(here) >= least) found.push_back(i);
  }
  return found;
}

/// Colours at `count` equal steps: those of the nearest point of the outline.
std::vector<std::vector<float>> colour_channels(const Outline& outline, std::size_t count) {
  const std::vector<double> lengths = arc_lengths(outline.points);
  std::vector<std::vector<float>> channels(3, std::vector<float>(count));
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = lengths.back() * static_cast<double>(i) / static_cast<double>(count);
    while (at + 1 < outline.colour.size() && lengths[at + 1] <= s) ++at;
    for (int k = 0; k < 3; ++k)
      channels[static_cast<std::size_t>(k)][i] = static_cast<float>(outline.colour[at][k]);
  }
  return channels;
}

}  // namespace

std::vector<glm::dvec2> resampled(const std::vector<glm::dvec2>& polygon, double step) {
  const std::vector<double> lengths = arc_lengths(polygon);
  const auto wanted = static_cast<std::size_t>(std::lround(lengths.back() / step));
  const std::size_t count = std::max(kFewestPoints, wanted);
  std::vector<glm::dvec2> points;
  points.reserve(count);
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = lengths.back() * static_cast<double>(i) / static_cast<double>(count);
    while (at + 1 < polygon.size() && lengths[at + 1] <= s) ++at;
    const double edge = lengths[at + 1] - lengths[at];
    const double share = edge > 0.0 ? (s - lengths[at]) / edge : 0.0;
    points.push_back(glm::mix(polygon[at], polygon[(at + 1) % polygon.size()], share));
  }
  return points;
}

std::vector<glm::dvec2> smoothed(const std::vector<glm::dvec2>& points, double deviation) {
  if (deviation <= 0.0) return points;
  const std::size_t count = points.size();
  const auto reach = std::min(static_cast<std::size_t>(std::ceil(3.0 * deviation)), (count - 1) / 2);
  std::vector<double> weights(reach + 1);
  double total = 0.0;
  for (std::size_t k = 0; k <= reach; ++k) {
    const double x = static_cast<double>(k) / deviation;
    weights[k] = std::exp(-0.5 * x * x);
    total += k == 0 ? weights[k] : 2.0 * weights[k];
  }
  std::vector<glm::dvec2> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    glm::dvec2 sum = weights[0] * points[i];
    for (std::size_t k = 1; k <= reach; ++k)
      sum += weights[k] * (points[(i + k) % count] + points[(i + count - k) % count]);
    out[i] = sum / total;
  }
  return out;
}

PropertyPlot::PropertyPlot(const Outline& outline, const PlotOptions& options) : step(0.0) {
  std::vector<glm::dvec2> even = resampled(outline.points, options.step);
  step = perimeter(outline.points) / static_cast<double>(even.size());
  if (!outline.colour.empty()) channels = colour_channels(outline, even.size());
  if (options.backward) {
    std::reverse(even.begin() + 1, even.end());
    for (std::vector<float>& channel : channels) std::reverse(channel.begin() + 1, channel.end());
  }
  points = smoothed(even, options.smoothing);
  const auto reach = static_cast<std::size_t>(std::max(1L, std::lround(options.smoothing)));
  channels.insert(channels.begin(), turns(points, reach));
  features = extremes(channels[0]);
}

}  // namespace rejoin::outline
