/// What is compared of outlines: evenly spaced, smoothed borders and their turning, from coarse to fine.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

/// Evenly spaced points of a closed polygon by arc length, beginning with its first point.
/// \pre count >= 1, the perimeter is positive
std::vector<glm::dvec2> resample(const std::vector<glm::dvec2>& polygon, std::size_t count);

/// The same with a wanted distance between the points, file units; at least 16 points are made, at most a million.
std::vector<glm::dvec2> resample_by(const std::vector<glm::dvec2>& polygon, double step);

/// Signed curvature at the points of a closed, evenly spaced curve, 1 / file unit; positive where it turns left (with y
/// up).  A circle of radius r that runs counter-clockwise gives 1 / r.  Central differences of second order.
std::vector<double> curvature(const std::vector<glm::dvec2>& points);

/// A border at one scale: smoothed by a Gaussian of width lambda = 4 step (4 standard deviations) and sampled each `step`.
struct ScaleSignal {
  double step = 0.0;               ///< between samples, file units; nearly the same for all pieces
  std::vector<glm::dvec2> points;  ///< of the smoothed border
  std::vector<float> turning;  ///< curvature * step: the angle by which the border turns at a sample, radians
  std::vector<double> places;  ///< arc length on the piece's own border, ascending, in [0, perimeter)
};

struct SignalOptions {
  double step = 0.0;  ///< of the finest scale, file units
  int scales = 5;     ///< each twice as coarse as the one before
};

/// A closed border at all scales, finest first.  \source leitao 2000, steps 2.1 to 2.3 and "Filtering and
/// resampling"; deviation: every scale is smoothed from the border itself, which a Gaussian after a Gaussian equals.
std::vector<ScaleSignal> scale_space(const std::vector<glm::dvec2>& border, const SignalOptions& options);

}  // namespace rejoin::outline
