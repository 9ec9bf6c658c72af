#include "anneal/chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "functions.hpp"

namespace rejoin::anneal {
namespace {

using testing::box;
using testing::quadratic;

ChainResult run(const std::vector<Variable>& variables, const Options& options,
                double (*energy)(std::span<const double>)) {
  Chain chain(variables, options, 0, {});
  while (!chain.done()) chain.receive(energy(chain.proposal()));
  return chain.take_result();
}

double constant(std::span<const double>) {
  return 3.0;
}

TEST(Chain, MovesTheLeastUsedVariablesFirst) {
  const auto variables = box(7, -1, 1);
  const Options options;
  Chain chain(variables, options, 0, {});
  chain.receive(1.0);  // the start point
  std::vector<int> uses(7, 0);
  for (int move = 0; move < 70 && !chain.done(); ++move) {
    ASSERT_EQ(chain.moved().size(), 2U);
    for (const std::size_t v : chain.moved()) ++uses[v];
    const auto [low, high] = std::minmax_element(uses.begin(), uses.end());
    EXPECT_LE(*high - *low, 1) << "after move " << move;
    chain.receive(1.0 + move % 2);
  }
}

TEST(Chain, AMoveChangesNoOtherVariables) {
  const auto variables = box(7, -1, 1);
  const Options options;
  Chain chain(variables, options, 0, {});
  chain.receive(0.0);
  std::vector<double> current(chain.proposal().begin(), chain.proposal().end());
  for (int move = 0; move < 40; ++move) {
    current.assign(chain.proposal().begin(), chain.proposal().end());
    chain.receive(1.0 + move);  // the Monte Carlo stage accepts every finite move
    for (std::size_t v = 0; v < 7; ++v) {
      const bool moved = std::find(chain.moved().begin(), chain.moved().end(), v) != chain.moved().end();
      if (!moved) {
        EXPECT_EQ(chain.proposal()[v], current[v]);
      }
    }
  }
}

TEST(Chain, TemperaturesFollowFromFiftyRises) {
  const auto variables = box(2, -1, 1);
  const Options options;
  Chain chain(variables, options, 0, {});
  // Energies 1, 3, 1, 3, ...: every second move rises, by 2.
  for (int k = 0; k < 101; ++k) chain.receive(k % 2 == 0 ? 1.0 : 3.0);
  chain.cancel();
  const ChainResult result = chain.take_result();
  EXPECT_EQ(result.history.size(), 1U);
  EXPECT_EQ(result.history[0].evaluations, 100);  // start + 99 moves: rises 50, falls 49
  EXPECT_NEAR(result.first_temperature, 2.0 / std::log(2.0), 1e-12);
  EXPECT_NEAR(result.stop_temperature, -(1e-6 * 2 + 1e-8) / std::log(0.5e-6 + 1e-8), 1e-15);
  EXPECT_EQ(result.ending, Ending::Cancelled);
}

TEST(Chain, AnnealsFromTheBestPointOfTheMonteCarloStage) {
  const auto variables = box(7, -1, 1);
  const Options options;
  Chain chain(variables, options, 0, {});
  std::vector<double> best;
  double lowest = 1e9;
  for (int k = 0; k < 100; ++k) {
    const double energy = k % 2 == 1 ? 9.0 : (k == 40 ? 1.0 : 5.0);
    if (energy < lowest) best.assign(chain.proposal().begin(), chain.proposal().end());
    lowest = std::min(lowest, energy);
    chain.receive(energy);
  }
  int same = 0;  // the first proposal of the annealing differs from the best point in M variables only
  for (std::size_t v = 0; v < 7; ++v) same += chain.proposal()[v] == best[v] ? 1 : 0;
  EXPECT_EQ(same, 5);
}

TEST(Chain, TheAverageUphillMoveIsAcceptedWithP0) {
  // Two levels along the first variable, so that every rise is the average rise.  When the first variable
  // moved and the second moves next, the next proposal shows whether the move was taken.
  const std::vector<Variable> variables(2, Variable{-1, 1, true});
  Options options;
  options.accepted = 1000000;
  options.attempted = 1000000;
  options.moves = 12000;
  options.moved_variables = 1;
  options.initial_acceptance = 0.3;
  options.first_step = 0.5;
  Chain chain(variables, options, 0, {});
  const auto energy = [](double x) { return x < 0 ? 1.0 : 3.0; };
  double state = 1;    // first variable of the current point ...
  bool known = false;  // ... unless the move before also moved it
  int rises = 0;
  int taken = 0;
  while (!chain.done()) {
    const double proposed = chain.proposal()[0];
    const bool moved_first = !chain.moved().empty() && chain.moved()[0] == 0;
    if (!moved_first) state = proposed;
    const bool usable = known;
    known = !moved_first;
    chain.receive(energy(proposed));
    const bool shows = !chain.done() && moved_first && chain.moved()[0] == 1;
    if (!shows || !usable || energy(proposed) < energy(state) + 1 || chain.spent() == 0) continue;
    ++rises;
    taken += chain.proposal()[0] == proposed ? 1 : 0;
  }
  ASSERT_GT(rises, 500);
  EXPECT_NEAR(static_cast<double>(taken) / rises, 0.3,
              4 * std::sqrt(0.3 * 0.7 / rises));  // 4 standard errors
}

TEST(Chain, AStageEndsAfterEightAcceptedOrEightyAttempted) {
  const auto variables = box(7, -1, 1);
  Options options;
  options.failed_stages = 1000;
  const ChainResult result = run(variables, options, quadratic);
  bool by_acceptance = false;
  for (std::size_t s = 1; s < result.history.size(); ++s) {
    const long length = result.history[s].evaluations - result.history[s - 1].evaluations;
    EXPECT_GE(length, s + 1 == result.history.size() ? 1 : 8);
    EXPECT_LE(length, 80);
    by_acceptance |= length < 80;
  }
  EXPECT_TRUE(by_acceptance);
}

TEST(Chain, WithBothCriteriaAStageNeedsEightyAttemptedAndEightAccepted) {
  const auto variables = box(7, -1, 1);
  Options options;
  options.failed_stages = 1000;
  options.equilibrium = Equilibrium::Both;
  const ChainResult result = run(variables, options, quadratic);
  bool beyond = false;
  for (std::size_t s = 1; s + 1 < result.history.size(); ++s) {  // the budget cuts the last one
    const long length = result.history[s].evaluations - result.history[s - 1].evaluations;
    EXPECT_GE(length, 80);
    beyond |= length > 80;
  }
  EXPECT_TRUE(beyond);  // cold stages wait for their eighth acceptance
}

TEST(Chain, CoolingStaysBetweenItsLimits) {
  const auto variables = box(7, -1, 1);
  Options options;
  options.failed_stages = 1000;
  options.moves = 20000;
  const ChainResult result = run(variables, options, quadratic);
  ASSERT_GT(result.history.size(), 10U);
  EXPECT_DOUBLE_EQ(result.history[1].temperature, result.first_temperature);
  for (std::size_t s = 2; s < result.history.size(); ++s) {
    const double rate = result.history[s].temperature / result.history[s - 1].temperature;
    EXPECT_GE(rate, 0.6 - 1e-12);
    EXPECT_LE(rate, 0.9 + 1e-12);
  }
}

TEST(Chain, EndsStalledAfterFourStagesWithoutANewBest) {
  const auto variables = box(7, -1, 1);
  Options options;
  options.attempted = 20;
  const ChainResult result = run(variables, options, quadratic);
  ASSERT_EQ(result.ending, Ending::Stalled);
  const auto& history = result.history;
  ASSERT_GE(history.size(), 5U);
  EXPECT_EQ(history[history.size() - 5].best, history.back().best);
  if (history.size() > 5) {
    EXPECT_GT(history[history.size() - 6].best, history.back().best);
  }
}

TEST(Chain, EndsFrozenAtTheStopTemperature) {
  const auto variables = box(7, -1, 1);
  Options options;
  options.failed_stages = 1000;
  options.moves = 1000000;
  const ChainResult result = run(variables, options, quadratic);
  EXPECT_EQ(result.ending, Ending::Frozen);
  EXPECT_GT(result.history.back().temperature, result.stop_temperature);
  EXPECT_LE(0.6 * result.history.back().temperature, result.stop_temperature);
}

TEST(Chain, EndsWhenTheMovesAreSpent) {
  const auto variables = box(7, -1, 1);
  Options options;
  options.failed_stages = 1000;
  options.moves = 333;
  const ChainResult result = run(variables, options, quadratic);
  EXPECT_EQ(result.ending, Ending::BudgetSpent);
  EXPECT_EQ(result.evaluations, result.history[0].evaluations + 333);
}

TEST(Chain, AFlatFunctionEndsAfterTheMonteCarloStage) {
  const auto variables = box(7, -1, 1);
  const ChainResult result = run(variables, Options(), constant);
  EXPECT_EQ(result.ending, Ending::Frozen);
  EXPECT_EQ(result.evaluations, 501);  // the start and 10 moves for each rise that never came
  EXPECT_EQ(result.energy, 3.0);
}

}  // namespace
}  // namespace rejoin::anneal
