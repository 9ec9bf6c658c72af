#include "outline/transport.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/random.hpp"

namespace rejoin::outline {
namespace {

/// A plot with the given turns and nothing else.
PropertyPlot plot_of(const std::vector<float>& turns) {
  Outline outline;
  for (int i = 0; i < 32; ++i) {
    const double angle = 2.0 * M_PI * i / 32.0;
    outline.points.push_back({std::cos(angle), std::sin(angle)});
  }
  PropertyPlot plot(outline, {0.1, 0.0, false});
  plot.points.resize(turns.size());
  plot.channels = {turns};
  return plot;
}

std::vector<float> random_turns(std::size_t count, Random& random) {
  std::vector<float> turns;
  turns.reserve(count);
  for (std::size_t i = 0; i < count; ++i) turns.push_back(static_cast<float>(random.uniform(-1.0, 1.0)));
  return turns;
}

Sand random_sand(std::size_t bins, Random& random) {
  return {plot_of(random_turns(bins, random)), 0, bins, bins};
}

TEST(Transport, EqualsTheBestOfAllAssignments) {
  Random random(7);
  const CostWeights weights;
  for (int round = 0; round < 20; ++round) {
    const Sand a = random_sand(6, random);
    const Sand b = random_sand(6, random);
    std::vector<std::size_t> to(6);
    std::iota(to.begin(), to.end(), 0U);
    double best = 1e9;
    do {
      double sum = 0.0;
      for (std::size_t i = 0; i < 6; ++i) {
        const double shift = std::abs(static_cast<double>(i) - static_cast<double>(to[i])) / 6.0;
        sum += weights.length * shift + weights.property * property_difference(a, i, b, to[i], 0.0);
      }
      best = std::min(best, sum / 6.0);
    } while (std::next_permutation(to.begin(), to.end()));
    EXPECT_NEAR(transport_cost(a, b, weights), best, 1e-6);
  }
}

TEST(Transport, LiesBetweenItsBounds) {
  Random random(8);
  const CostWeights weights;
  for (int round = 0; round < 50; ++round) {
    const Sand a = random_sand(24, random);
    const Sand b = random_sand(24, random);
    const double cost = transport_cost(a, b, weights);
    EXPECT_LE(unordered_cost(a, b, weights), cost + 1e-6);
    EXPECT_GE(ordered_cost(a, b, weights), cost - 1e-6);
    EXPECT_TRUE(transport_within(a, b, weights, cost + 1e-6));
    EXPECT_FALSE(transport_within(a, b, weights, cost - 1e-6));
  }
}

TEST(Transport, OneStepOfShiftCostsAtMostItsLength) {
  Random random(9);
  const PropertyPlot plot = plot_of(random_turns(100, random));
  const CostWeights weights;
  const Sand here(plot, 10, 20, 20);
  const Sand shifted(plot, 11, 20, 20);
  EXPECT_NEAR(transport_cost(here, here, weights), 0.0, 1e-9);
  // Every bin moves one place, and one bin across the whole stretch at worst with the largest property difference.
  const double most = weights.length * 2.0 / 20.0 + weights.property * 2.0 / M_PI / 20.0;
  EXPECT_LE(transport_cost(here, shifted, weights), most);
  EXPECT_LT(transport_cost(here, shifted, weights), ordered_cost(here, shifted, weights));
}

TEST(Transport, ColourCountsWithItsShare) {
  PropertyPlot grey = plot_of(std::vector<float>(16, 0.25F));
  PropertyPlot red = grey;
  grey.channels.resize(4, std::vector<float>(16, 0.5F));
  red.channels.resize(4, std::vector<float>(16, 0.5F));
  red.channels[1].assign(16, 1.0F);
  const Sand a(grey, 0, 16, 16);
  const Sand b(red, 0, 16, 16);
  EXPECT_NEAR(transport_cost(a, b, {0.5, 0.5, 0.0}), 0.0, 1e-7);
  EXPECT_NEAR(transport_cost(a, b, {0.5, 0.5, 0.6}), 0.5 * 0.6 * 0.5 / 3.0, 1e-6);
}

}  // namespace
}  // namespace rejoin::outline
