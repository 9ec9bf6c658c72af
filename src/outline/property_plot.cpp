#include "outline/property_plot.hpp"

#include <algorithm>

#include "core/smooth.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

// A feature turns at least this share of the mean turn.
constexpr float kFeatureShare = 1.0F;

/// Turn of the border over `reach` samples at each sample.
std::vector<float> turns(const std::vector<glm::dvec2>& points, std::size_t reach) {
  const std::size_t count = points.size();
  std::vector<float> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 before = points[i] - points[(i + count - reach) % count];
    const glm::dvec2 after = points[(i + reach) % count] - points[i];
    out[i] = static_cast<float>(std::atan2(cross(before, after), glm::dot(before, after)));
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

/// Colours at `count` equal steps: those of the outline's last point before each.
std::vector<std::vector<float>> colour_channels(const Outline& outline, std::size_t count) {
  std::vector<std::vector<float>> channels(3);
  for (const EdgePlace& place : even_places(arc_lengths(outline.points), count)) {
    for (int k = 0; k < 3; ++k)
      channels[static_cast<std::size_t>(k)].push_back(static_cast<float>(outline.colour[place.edge][k]));
  }
  return channels;
}

}  // namespace

PropertyPlot::PropertyPlot(const Outline& outline, const PlotOptions& options) : step(0.0) {
  std::vector<glm::dvec2> even = resample_by(outline.points, options.step);
  step = perimeter(outline.points) / static_cast<double>(even.size());
  if (!outline.colour.empty()) channels = colour_channels(outline, even.size());
  if (options.backward) {
    std::reverse(even.begin() + 1, even.end());
    for (std::vector<float>& channel : channels) std::reverse(channel.begin() + 1, channel.end());
  }
  points = smooth(even, options.smoothing);
  const auto reach = static_cast<std::size_t>(std::max(1L, std::lround(options.smoothing)));
  channels.insert(channels.begin(), turns(points, reach));
  features = extremes(channels[0]);
}

}  // namespace rejoin::outline
