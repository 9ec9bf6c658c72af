#include "anneal/chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rejoin::anneal {
namespace {

// The Monte Carlo stage gives up on more uphill moves after this many moves for each one asked for.
constexpr int kEstimateMovesPerRise = 10;

// Siarry et al. 1997: acceptance above and below which a step is doubled and halved.
constexpr double kBusy = 0.2;
constexpr double kIdle = 0.05;

double wrapped(double value, const Variable& range) {
  const double width = range.high - range.low;
  const double turns = std::floor((value - range.low) / width);
  const double inside = value - turns * width;
  return inside >= range.high ? range.low : std::max(inside, range.low);
}

// Folding, unlike clamping, keeps the proposal symmetric and does not pile points up at the bounds.
double folded(double value, const Variable& range) {
  const double width = range.high - range.low;
  const double offset = std::fmod(std::abs(value - range.low), 2 * width);
  return range.low + (offset > width ? 2 * width - offset : offset);
}

}  // namespace

Chain::Chain(std::span<const Variable> variables, const Options& options, std::uint64_t stream,
             std::span<const double> start)
    : variables_(variables), options_(options), random_(options.seed, stream) {
  const std::size_t count = variables.size();
  proposal_.assign(start.begin(), start.end());
  if (start.empty()) {
    for (const Variable& v : variables) proposal_.push_back(random_.uniform(v.low, v.high));
  }
  result_.point = proposal_;
  uses_.assign(count, 0);
  for (const Variable& v : variables) steps_.push_back(options.first_step * (v.high - v.low));
}

void Chain::receive(double energy) {
  if (std::isnan(energy)) energy = std::numeric_limits<double>::infinity();
  ++result_.evaluations;
  switch (phase_) {
    case Phase::Start:
      note_best(energy);
      accept(energy);
      phase_ = Phase::Estimate;
      break;
    case Phase::Estimate:
      receive_estimate(energy);
      break;
    case Phase::Anneal:
      receive_move(energy);
      break;
    case Phase::Done:
      return;
  }
  if (!done()) propose();
}

void Chain::note_best(double energy) {
  if (energy >= result_.energy) return;
  result_.energy = energy;
  result_.point = proposal_;
  improved_ = true;
}

void Chain::accept(double energy) {
  current_ = proposal_;
  current_energy_ = energy;
}

void Chain::receive_estimate(double energy) {
  ++estimate_moves_;
  note_best(energy);
  if (std::isfinite(energy) && std::isfinite(current_energy_) && energy > current_energy_) {
    rise_sum_ += energy - current_energy_;
    ++rises_;
  }
  if (std::isfinite(energy) || !std::isfinite(current_energy_)) accept(energy);
  if (rises_ >= options_.uphill_transitions ||
      estimate_moves_ >= kEstimateMovesPerRise * options_.uphill_transitions) {
    finish_estimate();
  }
}

void Chain::finish_estimate() {
  const double rise = rises_ > 0 ? rise_sum_ / rises_ : 0;
  const double p0 = options_.initial_acceptance;
  result_.first_temperature = -rise / std::log(p0);
  result_.stop_temperature = -(1e-6 * rise + 1e-8) / std::log(1e-6 * p0 + 1e-8);
  result_.history.push_back({result_.evaluations, result_.energy, result_.first_temperature});
  temperature_ = result_.first_temperature;
  current_ = result_.point;
  current_energy_ = result_.energy;
  phase_ = Phase::Anneal;
  begin_stage();
  // Nothing ever rose: a flat function, or nothing but forbidden points.
  if (temperature_ <= result_.stop_temperature) end(Ending::Frozen);
}

void Chain::begin_stage() {
  energy_sum_ = 0;
  energy_min_ = std::numeric_limits<double>::infinity();
  finite_states_ = 0;
  attempted_ = 0;
  accepted_ = 0;
  improved_ = false;
  tried_.assign(variables_.size(), 0);
  taken_.assign(variables_.size(), 0);
}

void Chain::receive_move(double energy) {
  ++moves_;
  ++attempted_;
  note_best(energy);
  bool taken = energy < current_energy_ || !std::isfinite(current_energy_);
  if (!taken && std::isfinite(energy)) {
    taken = random_.uniform() < std::exp(-(energy - current_energy_) / temperature_);
  }
  for (const std::size_t v : moved_) {
    ++tried_[v];
    taken_[v] += taken ? 1 : 0;
  }
  if (taken) {
    accept(energy);
    ++accepted_;
  }
  if (std::isfinite(current_energy_)) {
    energy_sum_ += current_energy_;
    energy_min_ = std::min(energy_min_, current_energy_);
    ++finite_states_;
  }
  const bool budget_spent = moves_ >= options_.moves;
  if (budget_spent || in_equilibrium()) finish_stage();
  if (budget_spent && !done()) end(Ending::BudgetSpent);
}

bool Chain::in_equilibrium() const {
  const bool tried = attempted_ >= options_.attempted;
  const bool taken = accepted_ >= options_.accepted;
  return options_.equilibrium == Equilibrium::Both ? tried && taken : tried || taken;
}

void Chain::finish_stage() {
  result_.history.push_back({result_.evaluations, result_.energy, temperature_});
  failed_ = improved_ ? 0 : failed_ + 1;
  adapt_steps();
  const double average = finite_states_ > 0 ? energy_sum_ / finite_states_ : 0;
  const double ratio = average > 0 ? energy_min_ / average : 1;
  temperature_ *= std::clamp(ratio, options_.cooling_min, options_.cooling_max);
  begin_stage();
  if (temperature_ <= result_.stop_temperature) {
    end(Ending::Frozen);
  } else if (failed_ >= options_.failed_stages) {
    end(Ending::Stalled);
  }
}

void Chain::adapt_steps() {
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    if (tried_[v] == 0) continue;
    const double width = variables_[v].high - variables_[v].low;
    const double share = static_cast<double>(taken_[v]) / tried_[v];
    if (share > kBusy) steps_[v] = std::min(2 * steps_[v], 0.5 * width);
    if (share < kIdle) steps_[v] = std::max(0.5 * steps_[v], options_.least_step * width);
  }
}

void Chain::pick_variables() {
  moved_.clear();
  for (int m = 0; m < options_.moved_variables; ++m) {
    std::size_t chosen = variables_.size();
    std::uint32_t ties = 0;
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      if (std::find(moved_.begin(), moved_.end(), v) != moved_.end()) continue;
      if (chosen < variables_.size() && uses_[v] > uses_[chosen]) continue;
      ties = chosen < variables_.size() && uses_[v] == uses_[chosen] ? ties + 1 : 1;
      if (random_.below(ties) == 0) chosen = v;
    }
    moved_.push_back(chosen);
  }
  for (const std::size_t v : moved_) ++uses_[v];
}

void Chain::propose() {
  pick_variables();
  proposal_ = current_;
  for (const std::size_t v : moved_) {
    const double value = current_[v] + random_.uniform(-steps_[v], steps_[v]);
    proposal_[v] = variables_[v].wraps ? wrapped(value, variables_[v]) : folded(value, variables_[v]);
  }
}

void Chain::end(Ending ending) {
  result_.ending = ending;
  phase_ = Phase::Done;
}

void Chain::cancel() {
  if (!done()) end(Ending::Cancelled);
}

double Chain::spent() const {
  return done() ? 1.0 : static_cast<double>(moves_) / std::max(1, options_.moves);
}

ChainResult Chain::take_result() {
  return std::move(result_);
}

}  // namespace rejoin::anneal
