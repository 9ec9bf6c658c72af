/// The slope changes of a border: what naiman's method compares.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace rejoin::outline {

struct TurnOptions {
  double step = 1.0;  ///< between samples, file units
  int window = 27;    ///< "edge characterization points": samples of one parabola, odd
  double straight_deg =
      0.6;  ///< "straight corner maximum": a change of slope below it counts as none, degrees a sample
};

/// A border, evenly sampled, with its changes of slope.
struct Turns {
  std::vector<glm::dvec2> points;  ///< samples, evenly spaced by nearly `step`
  std::vector<double> places;      ///< arc length of each sample along the outline it came from
  std::vector<float>
      change_deg;  ///< of the slope from sample i to i + 1, degrees; left turns are positive (y up)
  std::vector<float> values;         ///< the changes with every run of straight samples made one zero
  std::vector<std::uint32_t> index;  ///< of each value: its sample, the middle one of a run
  double step = 1.0;                 ///< the true spacing of the samples
};

/// Direction of a closed, evenly sampled curve at each sample: that of the least-squares parabola through the `window`
/// samples around it, radians, continuous along the curve.
/// \pre window is odd and at most the number of points
/// \source naiman 2018, section 5; deviation: x and y are each fitted over arc length, so that the fit turns with the piece
std::vector<double> slopes(const std::vector<glm::dvec2>& points, int window);

/// The slope changes of a border.
/// \source naiman 2018, sections 5 and 6.1
Turns turns_of(const std::vector<glm::dvec2>& border, const TurnOptions& options);

}  // namespace rejoin::outline
