/// One annealing chain as a state machine: it proposes a point, is told its energy, proposes the next.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "anneal/anneal.hpp"
#include "core/random.hpp"

namespace rejoin::anneal {

class Chain {
 public:
  /// \param start  D values inside the box, or empty: uniform in the box
  /// `variables` and `options` must outlive the chain.
  Chain(std::span<const Variable> variables, const Options& options, std::uint64_t stream,
        std::span<const double> start);

  bool done() const { return phase_ == Phase::Done; }

  /// The point whose energy the chain wants to know; valid until receive().  \pre !done()
  std::span<const double> proposal() const { return proposal_; }

  /// Variables that the present proposal changes; empty for the start point.
  std::span<const std::size_t> moved() const { return moved_; }

  /// Takes the energy of proposal() and prepares the next one.  \pre !done()
  void receive(double energy);

  void cancel();

  /// 0 .. 1: how much of the budget of moves is spent.
  double spent() const;

  ChainResult take_result();

 private:
  enum class Phase { Start, Estimate, Anneal, Done };

  void propose();
  void pick_variables();
  void note_best(double energy);
  void accept(double energy);
  void receive_estimate(double energy);
  void finish_estimate();
  void receive_move(double energy);
  bool in_equilibrium() const;
  void finish_stage();
  void begin_stage();
  void adapt_steps();
  void end(Ending ending);

  std::span<const Variable> variables_;
  const Options& options_;
  Random random_;
  Phase phase_ = Phase::Start;
  std::vector<double> current_;
  double current_energy_ = 0;
  std::vector<double> proposal_;
  std::vector<std::size_t> moved_;
  std::vector<long> uses_;     // how often each variable was moved
  std::vector<double> steps_;  // half width of a move, in the variable's unit
  std::vector<int> tried_;     // of this temperature, a variable
  std::vector<int> taken_;
  double rise_sum_ = 0;  // of the Monte Carlo stage
  int rises_ = 0;
  int estimate_moves_ = 0;
  double temperature_ = 0;
  double energy_sum_ = 0;  // of this temperature, finite states only
  double energy_min_ = 0;
  int finite_states_ = 0;
  int attempted_ = 0;
  int accepted_ = 0;
  bool improved_ = false;
  int failed_ = 0;
  int moves_ = 0;
  ChainResult result_;
};

}  // namespace rejoin::anneal
