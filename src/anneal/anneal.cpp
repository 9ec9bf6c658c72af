#include "anneal/anneal.hpp"

#include <algorithm>
#include <cmath>

#include "anneal/chain.hpp"
#include "core/error.hpp"

namespace rejoin::anneal {
namespace {

void require(bool good, const char* problem) {
  if (!good) throw InputError("annealing options", problem);
}

void check(std::span<const Variable> variables, const Options& o, std::span<const double> starts) {
  const std::size_t count = variables.size();
  require(count > 0, "no variables");
  for (const Variable& v : variables) {
    require(std::isfinite(v.low) && std::isfinite(v.high) && v.low < v.high, "a variable's range is empty");
  }
  require(o.chains > 0, "chains must be at least 1");
  require(o.initial_acceptance > 0 && o.initial_acceptance < 1, "initial_acceptance must lie in (0, 1)");
  require(o.uphill_transitions > 0, "uphill_transitions must be at least 1");
  require(o.moved_variables > 0 && static_cast<std::size_t>(o.moved_variables) <= count,
          "moved_variables must lie in 1 .. number of variables");
  require(o.attempted > 0 && o.accepted > 0, "attempted and accepted must be at least 1");
  require(o.cooling_min > 0 && o.cooling_min <= o.cooling_max && o.cooling_max < 1,
          "cooling must satisfy 0 < cooling_min <= cooling_max < 1");
  require(o.failed_stages > 0 && o.moves > 0, "failed_stages and moves must be at least 1");
  require(o.first_step > 0 && o.first_step <= 0.5, "first_step must lie in (0, 0.5]");
  require(o.least_step >= 0 && o.least_step <= o.first_step, "least_step must lie in 0 .. first_step");
  require(starts.empty() || starts.size() == count * static_cast<std::size_t>(o.chains),
          "starts must hold one point a chain");
}

// Evaluates the proposals of all running chains in one batch.
void advance(std::vector<Chain>& chains, const Energy& energy) {
  std::vector<double> points;
  std::vector<int> askers;
  for (std::size_t k = 0; k < chains.size(); ++k) {
    if (chains[k].done()) continue;
    const auto proposal = chains[k].proposal();
    points.insert(points.end(), proposal.begin(), proposal.end());
    askers.push_back(static_cast<int>(k));
  }
  std::vector<double> energies(askers.size());
  energy(points, askers, energies);
  for (std::size_t k = 0; k < askers.size(); ++k) {
    chains[static_cast<std::size_t>(askers[k])].receive(energies[k]);
  }
}

Result collect(std::vector<Chain>& chains) {
  Result result;
  for (Chain& chain : chains) {
    chain.cancel();  // no effect on those that ended by themselves
    result.chains.push_back(chain.take_result());
    const ChainResult& last = result.chains.back();
    result.evaluations += last.evaluations;
    if (last.energy < result.chains[result.best].energy) result.best = result.chains.size() - 1;
  }
  return result;
}

}  // namespace

Result minimise(std::span<const Variable> variables, const Energy& energy, const Options& options,
                const Context& context, std::span<const double> starts) {
  check(variables, options, starts);
  const std::size_t count = variables.size();
  std::vector<Chain> chains;
  for (std::size_t k = 0; k < static_cast<std::size_t>(options.chains); ++k) {
    const auto start = starts.empty() ? starts : starts.subspan(k * count, count);
    chains.emplace_back(variables, options, options.first_stream + k, start);
  }
  constexpr int kRoundsPerReport = 32;
  for (int round = 0; !context.cancelled(); ++round) {
    if (std::all_of(chains.begin(), chains.end(), [](const Chain& c) { return c.done(); })) break;
    advance(chains, energy);
    if (round % kRoundsPerReport == 0) {
      double spent = 1;
      for (const Chain& chain : chains) spent = std::min(spent, chain.spent());
      context.report("annealing", spent);
    }
  }
  return collect(chains);
}

}  // namespace rejoin::anneal
