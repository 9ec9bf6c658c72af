/// Enhanced Simulated Annealing of bounded functions of a few continuous variables.
///
/// \source papaioannou 2002, section 4, after Siarry, Berthiau, Durbin and Haussy 1997 (ACM TOMS 23,
/// 209-228).
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/context.hpp"

namespace rejoin::anneal {

/// Range of one variable.
struct Variable {
  double low = 0;
  double high = 1;     ///< > low
  bool wraps = false;  ///< low and high are one place (an angle); otherwise moves fold back at the bounds
};

/// How the two numbers of moves at one temperature combine.  The paper defines equilibrium by one "or" the other and
/// then uses "both criteria"; Siarry et al. 1997 end a temperature by either.
enum class Equilibrium {
  Either,  ///< enough moves tried or enough accepted: short hot stages, so N_fail ends a run early
  Both,    ///< enough moves tried and enough accepted: three times as many moves a run
};

/// The paper's numbers are the defaults.
struct Options {
  int chains = 1;  ///< independent annealings that advance together, each with its own random stream
  std::uint64_t seed = 1;
  std::uint64_t first_stream = 0;   ///< chain k draws from stream first_stream + k
  double initial_acceptance = 0.5;  ///< P0: acceptance of the average uphill move at T0, in (0, 1)
  int uphill_transitions = 50;      ///< of the Monte Carlo stage that sets T0 and T_stop
  int moved_variables = 2;          ///< M: variables that one move changes
  Equilibrium equilibrium = Equilibrium::Either;
  int attempted = 80;        ///< moves tried at one temperature
  int accepted = 8;          ///< moves accepted at one temperature
  double cooling_min = 0.6;  ///< a_min
  double cooling_max = 0.9;  ///< a_max
  int failed_stages = 4;     ///< N_fail: temperatures in a row without a new best
  int moves = 2000;          ///< N_iter: moves after the Monte Carlo stage
  double first_step = 0.25;  ///< half width of the first moves, as a fraction of a variable's range, (0, 0.5]
  double least_step = 1e-4;  ///< moves never become smaller than this fraction of the range
};

/// Energies of a batch of points.
/// \param points    K x D values, point after point
/// \param chains    K numbers: which chain asks (0 .. Options.chains - 1)
/// \param energies  K results; +infinity marks a forbidden point, NaN is treated alike
using Energy = std::function<void(std::span<const double> points, std::span<const int> chains,
                                  std::span<double> energies)>;

enum class Ending {
  Frozen,       ///< the temperature reached T_stop
  Stalled,      ///< N_fail temperatures without a new best
  BudgetSpent,  ///< N_iter moves
  Cancelled,    ///< the context asked to stop
};

/// Frozen and Stalled: the search ended by itself.
inline bool converged(Ending ending) {
  return ending == Ending::Frozen || ending == Ending::Stalled;
}

/// End of one temperature.
struct Stage {
  long evaluations;    ///< of this chain so far
  double best;         ///< lowest energy so far
  double temperature;  ///< of this stage
};

struct ChainResult {
  std::vector<double> point;  ///< the best one, D values
  double energy = std::numeric_limits<double>::infinity();
  Ending ending = Ending::Cancelled;
  long evaluations = 0;
  std::vector<Stage> history;    ///< the Monte Carlo stage (temperature T0), then every temperature
  double first_temperature = 0;  ///< T0
  double stop_temperature = 0;   ///< T_stop
};

struct Result {
  std::vector<ChainResult> chains;  ///< in the order of their numbers
  std::size_t best = 0;             ///< number of the chain with the lowest energy (the first of equals)
  long evaluations = 0;
};

/// Minimises `energy` over the box of `variables`.
///
/// Every chain: (1) starts at its start point and walks with every move accepted until `uphill_transitions`
/// moves went up (at most 10 times as many moves), which sets
///   T0 = -D / ln P0,   T_stop = -(1e-6 D + 1e-8) / ln(1e-6 P0 + 1e-8),   D = mean rise of the uphill moves;
/// (2) anneals from the best point of that walk: Metropolis acceptance, a temperature ends after `attempted`
/// moves or `accepted` acceptances, then T *= clamp(e_min / e_ave, cooling_min, cooling_max); (3) ends by
/// T_stop, by `failed_stages` temperatures without a new best, or by `moves`.
///
/// A move changes the M least often used variables (ties at random), each by a uniform amount in +- its step.
/// The paper leaves the step open; as in Siarry et al. it starts as a fraction of the range and is adapted a
/// variable after every temperature: doubled where over 20 % of its moves were accepted (up to half the
/// range), halved below 5 %. e_min and e_ave are taken over the state after every move.  Moves to +infinity
/// are accepted only from +infinity, and infinite energies enter neither the averages nor D.  The cooling
/// rule expects positive energies; where e_ave is not positive, the slow rate cooling_max is used.
///
/// All running chains are evaluated in one call of `energy`, in the order of their numbers; those that ended
/// drop out. The result depends on the options alone, not on threads. \param starts  chains x D start points,
/// or empty: uniform in the box \throws InputError an option or a range is unusable \source papaioannou 2002,
/// section 4; deviation: the step rule (open there).
Result minimise(std::span<const Variable> variables, const Energy& energy, const Options& options,
                const Context& context, std::span<const double> starts = {});

}  // namespace rejoin::anneal
