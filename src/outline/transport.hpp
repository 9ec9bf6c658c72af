/// Earth mover's cost between two stretches of border.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/property_plot.hpp"

namespace rejoin::outline {

/// Weights of zhang 2016, eq. (1).
struct CostWeights {
  double length = 0.5;    ///< lambda_1, of the difference of the positions, each 0..1 along its stretch
  double property = 0.5;  ///< lambda_2, of the difference of the properties
  double colour = 0.0;    ///< share of colour in the property, 0..1; the rest is curvature
};

/// A stretch cut into bins of equal length: each holds as much sand and one value a channel.
struct Sand {
  /// \param begin  first sample, any number (it wraps)   \param count  samples, > 0   \param bins  > 0
  Sand(const PropertyPlot& plot, long begin, std::size_t count, std::size_t bins);

  std::size_t bins;
  std::vector<std::vector<float>> channels;  ///< turn / pi, then colours if there are any
};

/// Difference of the properties of a bin of a and a bin of b, 0..2.
double property_difference(const Sand& a, std::size_t i, const Sand& b, std::size_t j, double colour_share);

/// Least cost of moving a's sand to b's: the transport problem solved by the network simplex method.
/// \return cost >= 0 per unit of sand, where each stretch holds one unit in all; accurate to 1e-6
/// \pre the same number of bins
/// \source zhang 2016, section 3
double transport_cost(const Sand& a, const Sand& b, const CostWeights& weights);

/// Cost when every bin goes to its counterpart in order: never below transport_cost().
double ordered_cost(const Sand& a, const Sand& b, const CostWeights& weights);

/// Cost of turning one distribution of curvatures into the other wherever they lie: never above transport_cost().
double unordered_cost(const Sand& a, const Sand& b, const CostWeights& weights);

/// Whether transport_cost() is at most `limit`; solves the transport problem only if the two bounds leave it open.
bool transport_within(const Sand& a, const Sand& b, const CostWeights& weights, double limit);

}  // namespace rejoin::outline
