#include "anneal/anneal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "functions.hpp"

namespace rejoin::anneal {
namespace {

using testing::batch;
using testing::box;
using testing::kPi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Options patient(int chains) {
  Options options;
  options.chains = chains;
  options.moves = 20000;
  options.failed_stages = 60;
  return options;
}

Result run(const std::vector<Variable>& variables, const Energy& energy, const Options& options) {
  return minimise(variables, energy, options, Context());
}

TEST(Anneal, DefaultsAreThePapersNumbers) {
  const Options o;
  EXPECT_DOUBLE_EQ(o.initial_acceptance, 0.5);
  EXPECT_EQ(o.uphill_transitions, 50);
  EXPECT_EQ(o.moved_variables, 2);
  EXPECT_EQ(o.attempted, 80);
  EXPECT_EQ(o.accepted, 8);
  EXPECT_DOUBLE_EQ(o.cooling_min, 0.6);
  EXPECT_DOUBLE_EQ(o.cooling_max, 0.9);
  EXPECT_EQ(o.failed_stages, 4);
  EXPECT_EQ(o.moves, 2000);
}

TEST(Anneal, FindsTheMinimumOfAQuadraticInSevenDimensions) {
  const auto result = run(box(7, -1, 1), batch(testing::quadratic), patient(4));
  EXPECT_LT(result.chains[result.best].energy, 1e-4);
  for (const double v : result.chains[result.best].point) EXPECT_NEAR(v, 0.3, 0.01);
}

TEST(Anneal, FollowsRosenbrocksValley) {
  const auto result = run(box(2, -2, 2), batch(testing::rosenbrock), patient(4));
  EXPECT_LT(result.chains[result.best].energy, 0.01);
  EXPECT_NEAR(result.chains[result.best].point[0], 1.0, 0.1);
}

TEST(Anneal, FindsTheDeepestHollowAcrossTheSeamOfAngles) {
  const auto result = run(box(7, 0, 2 * kPi, true), batch(testing::wrapped_rastrigin), patient(8));
  EXPECT_LT(result.chains[result.best].energy, 0.01);  // the next hollow costs 1.4 in one angle alone
}

TEST(Anneal, StartsFromThePointsGiven) {
  const std::vector<double> starts = {0.25, -0.5, 0.75, 0.125};
  std::vector<double> first;
  const Energy energy = [&](std::span<const double> points, std::span<const int>,
                            std::span<double> energies) {
    if (first.empty()) first.assign(points.begin(), points.end());
    std::fill(energies.begin(), energies.end(), 1.0);
  };
  Options options;
  options.chains = 2;
  minimise(box(2, -1, 1), energy, options, Context(), starts);
  EXPECT_EQ(first, starts);
}

TEST(Anneal, EveryPointLiesInTheBox) {
  const auto variables = std::vector<Variable>{{-1, 1, false}, {0, 2 * kPi, true}, {5, 5.5, false}};
  bool inside = true;
  const auto energy = batch([&](std::span<const double> x) {
    for (std::size_t v = 0; v < 3; ++v) inside &= x[v] >= variables[v].low && x[v] <= variables[v].high;
    return x[0] * x[0] + std::cos(x[1]) + x[2];
  });
  Options options = patient(3);
  options.first_step = 0.5;
  run(variables, energy, options);
  EXPECT_TRUE(inside);
}

TEST(Anneal, SameSeedSameResultAndChainsDoNotDependOnTheirNeighbours) {
  const auto variables = box(7, 0, 2 * kPi, true);
  Options options;
  options.chains = 5;
  options.seed = 77;
  const auto five = run(variables, batch(testing::wrapped_rastrigin), options);
  const auto again = run(variables, batch(testing::wrapped_rastrigin), options);
  options.chains = 1;
  options.first_stream = 3;
  const auto alone = run(variables, batch(testing::wrapped_rastrigin), options);
  EXPECT_EQ(five.chains[3].point, again.chains[3].point);
  EXPECT_EQ(five.evaluations, again.evaluations);
  EXPECT_EQ(five.chains[3].point, alone.chains[0].point);
  EXPECT_EQ(five.chains[3].evaluations, alone.chains[0].evaluations);
  EXPECT_NE(five.chains[0].point, five.chains[1].point);
}

TEST(Anneal, ChainsThatEndedDropOutOfTheBatch) {
  Options options;
  options.chains = 6;
  std::size_t previous = 6;
  std::size_t smallest = 6;
  long asked = 0;
  const Energy energy = [&](std::span<const double> points, std::span<const int> chains,
                            std::span<double> e) {
    EXPECT_EQ(points.size(), 7 * chains.size());
    EXPECT_LE(chains.size(), previous);
    previous = chains.size();
    smallest = std::min(smallest, previous);
    asked += static_cast<long>(chains.size());
    for (std::size_t k = 0; k < chains.size(); ++k) e[k] = testing::quadratic(points.subspan(7 * k, 7));
  };
  const auto result = run(box(7, -1, 1), energy, options);
  EXPECT_LT(smallest, 6U);
  EXPECT_EQ(result.evaluations, asked);
}

TEST(Anneal, ForbiddenPointsAreNeverTheResultOnceAPermittedOneWasSeen) {
  // Only a slab of a fifth of the box is permitted.
  const auto energy = batch([](std::span<const double> x) {
    if (x[0] < 0.2 || x[0] > 0.6) return x[1] > 0 ? kInfinity : std::numeric_limits<double>::quiet_NaN();
    return 1 + testing::quadratic(x);
  });
  const auto result = run(box(3, -1, 1), energy, patient(4));
  for (const ChainResult& chain : result.chains) {
    ASSERT_TRUE(std::isfinite(chain.energy));
    EXPECT_TRUE(std::isfinite(chain.first_temperature));
    EXPECT_LT(chain.energy, 1.02);
  }
}

TEST(Anneal, NothingButForbiddenPointsEndsWithInfinity) {
  const auto result = run(box(3, -1, 1), batch([](std::span<const double>) { return kInfinity; }), Options());
  EXPECT_EQ(result.chains[0].energy, kInfinity);
  EXPECT_EQ(result.chains[0].point.size(), 3U);
  EXPECT_TRUE(converged(result.chains[0].ending));
}

TEST(Anneal, CancelEndsAtOnceWithTheBestSoFar) {
  Context context;
  int calls = 0;
  const Energy energy = [&](std::span<const double> points, std::span<const int>,
                            std::span<double> energies) {
    if (++calls == 30) context.cancel();
    energies[0] = testing::quadratic(points);
  };
  const auto result = minimise(box(3, -1, 1), energy, Options(), context);
  EXPECT_EQ(calls, 30);
  EXPECT_EQ(result.chains[0].ending, Ending::Cancelled);
  EXPECT_FALSE(converged(result.chains[0].ending));
  EXPECT_EQ(result.chains[0].evaluations, 30);
  EXPECT_LT(result.chains[0].energy, 3.0);
}

TEST(Anneal, ReportsProgressThatEndsBelowOne) {
  double last = -1;
  const Context context([&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "annealing");
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  minimise(box(3, -1, 1), batch(testing::quadratic), patient(1), context);
  EXPECT_GT(last, 0.0);
  EXPECT_LE(last, 1.0);
}

TEST(Anneal, UnusableOptionsAreRefused) {
  const auto energy = batch(testing::quadratic);
  const auto refused = [&](auto change) {
    Options options;
    change(options);
    EXPECT_THROW(run(box(3, -1, 1), energy, options), InputError);
  };
  refused([](Options& o) { o.chains = 0; });
  refused([](Options& o) { o.moved_variables = 4; });
  refused([](Options& o) { o.initial_acceptance = 1; });
  refused([](Options& o) { o.cooling_max = 0.5; });
  refused([](Options& o) { o.moves = 0; });
  refused([](Options& o) { o.first_step = 0; });
  EXPECT_THROW(run(box(3, 1, 1), energy, Options()), InputError);
  EXPECT_THROW(run({}, energy, Options()), InputError);
  const std::vector<double> short_start(2, 0.0);
  EXPECT_THROW(minimise(box(3, -1, 1), energy, Options(), Context(), short_start), InputError);
}

}  // namespace
}  // namespace rejoin::anneal
