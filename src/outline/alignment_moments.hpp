/// Where two property plots look alike: starting points for common boundaries.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/property_plot.hpp"

namespace rejoin::outline {

/// A sample of A's plot that may meet a sample of B's backward plot.
struct Moment {
  std::size_t a = 0;
  std::size_t b = 0;
  float gain =
      0.0F;  ///< mean turn of both stretches around it minus their mean difference, radians, summed; > 0
};

struct MomentOptions {
  std::size_t reach = 20;        ///< samples compared on either side
  std::size_t most = 24;         ///< moments kept
  double length_weight = 0.1;    ///< lambda_1 while capturing moments
  double property_weight = 0.9;  ///< lambda_2 while capturing moments
  double colour_share = 0.0;     ///< of colour in the property, 0..1
};

/// The best moments, best first, at most one for each way of laying the borders along each other.
/// \param a  plot run forward   \param b  plot run backward, with the same step
/// \source zhang 2016, section 4.2: features align where the cost with lambda 0.1 / 0.9 is small
std::vector<Moment> alignment_moments(const PropertyPlot& a, const PropertyPlot& b,
                                      const MomentOptions& options);

}  // namespace rejoin::outline
