#include "runs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace rejoin::bench {
namespace {

constexpr double kSameDisplacement = 0.05;  // figure 12: +-5 % RMS deviation counts as the same pose

match::Options search_options(Knowledge knowledge, const PairTruth& truth, const RunOptions& run) {
  match::Options options;
  options.search = match::Search::Esa;
  options.constraint =
      knowledge == Knowledge::Nothing ? match::Constraint::None : match::Constraint::Direction;
  if (knowledge == Knowledge::TrueDirection) {
    options.directions_a = {*truth.direction()};
    options.directions_b = {-(glm::transpose(truth.pose().rotation) * *truth.direction())};
  }
  options.resolution = run.resolution;
  options.backend = run.backend;
  options.chains = run.seeds;
  options.seed = run.first_seed;
  return options;
}

// A run is one chain of every combination; its answer is the one with the lowest energy.
std::vector<match::EsaHypothesis> best_of_each_run(const std::vector<match::EsaHypothesis>& ends, int seeds) {
  std::vector<match::EsaHypothesis> best(static_cast<std::size_t>(seeds));
  for (match::EsaHypothesis& h : best) h.energy = std::numeric_limits<double>::infinity();
  for (const match::EsaHypothesis& h : ends) {
    match::EsaHypothesis& present = best[static_cast<std::size_t>(h.chain)];
    if (h.energy < present.energy) present = h;
  }
  std::erase_if(best, [](const match::EsaHypothesis& h) { return !std::isfinite(h.energy); });
  return best;
}

void add(Group& group, const match::EsaHypothesis& h) {
  group.mean_error = (group.mean_error * group.runs + h.score.error) / (group.runs + 1);
  ++group.runs;
}

// The largest set of wrong answers around one of them.
Group most_frequent(const std::vector<match::EsaHypothesis>& wrong, const PairTruth& truth) {
  Group largest;
  for (const match::EsaHypothesis& centre : wrong) {
    Group group;
    for (const match::EsaHypothesis& h : wrong) {
      if (truth.deviation(h.pose, centre.pose).displacement <= kSameDisplacement) add(group, h);
    }
    if (group.runs > largest.runs) largest = group;
  }
  return largest;
}

std::optional<double> error_at(const match::Fragment& a, const match::Fragment& b, const PairTruth& truth,
                               const RunOptions& run) {
  if (!truth.direction()) return std::nullopt;
  const zbuffer::ViewOptions view = match::whole_fragment_view(a, b, run.resolution);
  const match::ViewCentres centres{a.coarse.origin + glm::dvec3(view.centre_a),
                                   b.coarse.origin + glm::dvec3(view.centre_b)};
  const auto facing = match::facing_view(truth.pose(), *truth.direction(), centres);
  zbuffer::PairScore score;
  zbuffer::make_scorer(run.backend, a.coarse, b.coarse, view)->score({&facing.view, 1}, {&score, 1});
  return score.error;
}

}  // namespace

std::optional<Outcome> measure(const match::Fragment& a, const match::Fragment& b, const PairTruth& truth,
                               Knowledge knowledge, const RunOptions& run) {
  if (knowledge == Knowledge::TrueDirection && !truth.direction()) return std::nullopt;
  match::EsaOptions esa;
  esa.maps = run.maps;
  esa.rule.overlap_bias = run.overlap_bias;
  esa.directions_per_fragment = run.directions;
  esa.shift_range = run.shift_range;
  esa.annealing.equilibrium = run.equilibrium;
  esa.annealing.failed_stages = run.failed_stages;
  esa.every_chain = true;
  match::EsaStats stats;
  const auto begin = std::chrono::steady_clock::now();
  const auto ends = match::esa_search(a, b, search_options(knowledge, truth, run), esa, Context(), &stats);
  if (ends.empty()) return std::nullopt;

  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.evaluations = stats.evaluations;
  outcome.error_at_truth = error_at(a, b, truth, run);
  outcome.runs = run.seeds;
  std::vector<match::EsaHypothesis> wrong;
  for (const match::EsaHypothesis& h : best_of_each_run(ends, run.seeds)) {
    if (truth.right(h.pose)) {
      add(outcome.right, h);
    } else {
      wrong.push_back(h);
    }
  }
  outcome.wrong = most_frequent(wrong, truth);
  return outcome;
}

}  // namespace rejoin::bench
