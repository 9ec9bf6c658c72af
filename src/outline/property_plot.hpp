/// Property plots of a border: curvature and colour along its arc length.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

/// What makes a plot.
struct PlotOptions {
  double step = 1.0;       ///< between samples, file units
  double smoothing = 2.0;  ///< deviation of the Gaussian on the points, in samples
  bool backward = false;   ///< run the border the other way round, as the counterpart of a join does
};

/// Channels along a border at equal steps.  Channel 0: turn of the smoothed border over the smoothing's width, radians,
/// positive to the left; channels 1..3: sRGB where the outline has colours.
/// \source zhang 2016, section 4.1
struct PropertyPlot {
  PropertyPlot(const Outline& outline, const PlotOptions& options);

  std::size_t size() const { return points.size(); }

  double step;                               ///< file units
  std::vector<glm::dvec2> points;            ///< smoothed
  std::vector<std::vector<float>> channels;  ///< one or four, each size() long
  std::vector<std::size_t> features;         ///< samples where the turn is locally largest, either way
};

}  // namespace rejoin::outline
