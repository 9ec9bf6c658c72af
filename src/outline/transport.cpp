#include "outline/transport.hpp"

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cmath>

#include "core/cyclic.hpp"

namespace rejoin::outline {
namespace {

// Costs are integers for the solver, so that its result does not depend on the order of sums.
constexpr double kUnit = 1e7;

}  // namespace

Sand::Sand(const PropertyPlot& plot, long begin, std::size_t count, std::size_t bins_) : bins(bins_) {
  const std::size_t size = plot.size();
  channels.reserve(plot.channels.size());
  for (std::size_t c = 0; c < plot.channels.size(); ++c) {
    const float unit = c == 0 ? static_cast<float>(1.0 / M_PI) : 1.0F;
    std::vector<float> values(bins, 0.0F);
    for (std::size_t k = 0; k < bins; ++k) {
      // Mean of the samples that fall into the bin, at least one.
      const std::size_t first = k * count / bins;
      const std::size_t last = std::max(first + 1, (k + 1) * count / bins);
      float sum = 0.0F;
      for (std::size_t s = first; s < last; ++s) {
        sum += plot.channels[c][wrapped(begin + static_cast<long>(s), size)];
      }
      values[k] = unit * sum / static_cast<float>(last - first);
    }
    channels.push_back(std::move(values));
  }
}

double property_difference(const Sand& a, std::size_t i, const Sand& b, std::size_t j, double colour_share) {
  const double turn = std::abs(a.channels[0][i] - b.channels[0][j]);
  if (colour_share <= 0.0 || a.channels.size() < 4 || b.channels.size() < 4) return turn;
  double colour = 0.0;
  for (std::size_t c = 1; c < 4; ++c) colour += std::abs(a.channels[c][i] - b.channels[c][j]);
  return (1.0 - colour_share) * turn + colour_share * colour / 3.0;
}

double transport_cost(const Sand& a, const Sand& b, const CostWeights& weights) {
  using Graph = lemon::SmartDigraph;
  const auto bins = static_cast<int>(a.bins);
  Graph graph;
  graph.reserveNode(2 * bins);
  graph.reserveArc(bins * bins);
  for (int i = 0; i < 2 * bins; ++i) graph.addNode();
  Graph::NodeMap<int> supply(graph, 1);
  for (int j = 0; j < bins; ++j) supply[Graph::nodeFromId(bins + j)] = -1;
  Graph::ArcMap<long long> cost(graph);
  for (int i = 0; i < bins; ++i) {
    for (int j = 0; j < bins; ++j) {
      const double shift = std::abs(i - j) / static_cast<double>(bins);
      const double property =
          property_difference(a, static_cast<std::size_t>(i), b, static_cast<std::size_t>(j), weights.colour);
      cost[graph.addArc(Graph::nodeFromId(i), Graph::nodeFromId(bins + j))] =
          std::llround(kUnit * (weights.length * shift + weights.property * property));
    }
  }
  lemon::NetworkSimplex<Graph, int, long long> simplex(graph);
  simplex.costMap(cost).supplyMap(supply).run();
  return static_cast<double>(simplex.totalCost()) / kUnit / bins;
}

double ordered_cost(const Sand& a, const Sand& b, const CostWeights& weights) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.bins; ++k) sum += property_difference(a, k, b, k, weights.colour);
  return weights.property * sum / static_cast<double>(a.bins);
}

double unordered_cost(const Sand& a, const Sand& b, const CostWeights& weights) {
  std::vector<float> ours = a.channels[0];
  std::vector<float> theirs = b.channels[0];
  std::sort(ours.begin(), ours.end());
  std::sort(theirs.begin(), theirs.end());
  double sum = 0.0;
  for (std::size_t k = 0; k < a.bins; ++k) sum += std::abs(ours[k] - theirs[k]);
  const bool coloured = a.channels.size() >= 4 && b.channels.size() >= 4;
  const double share = coloured ? 1.0 - weights.colour : 1.0;
  return weights.property * share * sum / static_cast<double>(a.bins);
}

bool transport_within(const Sand& a, const Sand& b, const CostWeights& weights, double limit) {
  if (ordered_cost(a, b, weights) <= limit) return true;
  if (unordered_cost(a, b, weights) > limit) return false;
  return transport_cost(a, b, weights) <= limit;
}

}  // namespace rejoin::outline
