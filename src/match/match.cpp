#include "match/match.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "match/align.hpp"
#include "match/esa_search.hpp"
#include "match/sweep.hpp"
#include "match/verify.hpp"

namespace rejoin::match {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kFacetSpread_deg =
    25.0;  // how far a facet's mean normal may lie from the direction that a user sees

constexpr std::size_t kEvenIfCancelled = 6;

/// A pose on its way through the stages; relative to the meshes' origins.
struct Hypothesis {
  Rigid pose;
  Evidence evidence;
  double strength = 0;
  int facet_a = -1;
  int facet_b = -1;
};

/// Facets that face one of the directions, or the one that comes closest.
std::vector<int> facets_facing(const Fragment& fragment, const std::vector<glm::dvec3>& directions,
                               double tolerance_deg) {
  std::vector<int> list;
  const double limit = std::cos((tolerance_deg + kFacetSpread_deg) * kDegree);
  for (const auto& direction : directions) {
    int closest = -1;
    double best = -2.0;
    for (int f = 0; f < static_cast<int>(fragment.facets.facets.size()); ++f) {
      const double cosine =
          glm::dot(fragment.facets.facets[static_cast<std::size_t>(f)].normal, glm::normalize(direction));
      if (cosine > limit) list.push_back(f);
      if (cosine <= best) continue;
      best = cosine;
      closest = f;
    }
    if (closest >= 0) list.push_back(closest);
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

std::vector<int> allowed_facets(const Fragment& fragment, const std::vector<int>& chosen,
                                const std::vector<glm::dvec3>& directions, const Options& options) {
  if (!chosen.empty()) return chosen;
  if (options.constraint != Constraint::Direction) return {};
  return facets_facing(fragment, directions, options.tolerance_deg);
}

bool axes_agree(const Rigid& pose, const Options& options) {
  if (options.constraint != Constraint::Material || !options.material_a || !options.material_b) return true;
  const double cosine = std::abs(
      glm::dot(glm::normalize(*options.material_a), pose.rotation * glm::normalize(*options.material_b)));
  return cosine > std::cos((options.tolerance_deg + 10.0) * kDegree);
}

std::vector<Hypothesis> run_sweep(const Fragment& a, const Fragment& b, const Options& options,
                                  const Context& context, Result& result) {
  SweepOptions sweep_options;
  sweep_options.facets_a = allowed_facets(a, options.facets_a, options.directions_a, options);
  sweep_options.facets_b = allowed_facets(b, options.facets_b, options.directions_b, options);
  const SweepResult swept = sweep(a, b, sweep_options, context);
  result.evaluations = swept.evaluations;
  std::vector<Hypothesis> hypotheses;
  for (const auto& hit : swept.hits) {
    if (axes_agree(hit.pose, options)) hypotheses.push_back({hit.pose, {}, 0.0, hit.facet_a, hit.facet_b});
  }
  return hypotheses;
}

std::vector<Hypothesis> run_esa(const Fragment& a, const Fragment& b, const Options& options,
                                const Context& context, Result& result) {
  EsaStats stats;
  Options all = options;
  all.max_candidates = std::max(options.max_candidates, 24);
  std::vector<Hypothesis> hypotheses;
  for (const auto& found : esa_search(a, b, all, EsaOptions{}, context, &stats)) {
    const Rigid from_file_a{glm::dmat3(1.0), -a.surface.origin};
    const Rigid to_file_b{glm::dmat3(1.0), b.surface.origin};
    hypotheses.push_back({from_file_a * found.pose * to_file_b, {}, 0.0, found.facet_a, found.facet_b});
  }
  result.evaluations = stats.evaluations;
  result.convergence = std::move(stats.convergence);
  result.warnings.insert(result.warnings.end(), stats.warnings.begin(), stats.warnings.end());
  return hypotheses;
}

void sort_by_strength(std::vector<Hypothesis>& list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Hypothesis& x, const Hypothesis& y) { return x.strength > y.strength; });
}

/// One round of alignment over all hypotheses that are left.
struct Pass {
  AlignOptions align;
  int evidence_samples = 0;  ///< of B that are looked at; 0: all
  bool facet_only = false;   ///< only the facet of B that the hypothesis came from
};

/// Aligns every hypothesis and weighs its evidence.  After a cancel only the first few still are, so that what was found is
/// not lost; the others are dropped.
void refine(std::vector<Hypothesis>& list, const Joint& joint, const Pass& pass, const Context& context) {
  std::vector<char> done(list.size(), 0);
  parallel_for(list.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (context.cancelled() && k >= kEvenIfCancelled) continue;
      Hypothesis& hypothesis = list[k];
      AlignOptions options = pass.align;
      options.facet_b = pass.facet_only ? hypothesis.facet_b : -1;
      hypothesis.pose = joint.align(hypothesis.pose, options);
      hypothesis.evidence = joint.evidence(hypothesis.pose, pass.evidence_samples, options.facet_b);
      hypothesis.strength = strength(hypothesis.evidence);
      done[k] = 1;
    }
  });
  std::vector<Hypothesis> kept;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (done[k] != 0) kept.push_back(list[k]);
  }
  list.swap(kept);
  sort_by_strength(list);
}

std::vector<Hypothesis> distinct(const std::vector<Hypothesis>& list, const Fragment& b, double diameter,
                                 std::size_t most) {
  const glm::dvec3 centre = mesh::centroid(b.surface);
  std::vector<Hypothesis> kept;
  for (const auto& hypothesis : list) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& other) {
      return same_pose(other.pose, hypothesis.pose, centre, diameter);
    });
    if (!known) kept.push_back(hypothesis);
    if (kept.size() == most) break;
  }
  return kept;
}

}  // namespace

Result match(const Fragment& a, const Fragment& b, const Options& options, const Context& context) {
  Result result;
  Stopwatch clock(result.stages);
  Verifier verifier(a, b, options);
  result.backend = verifier.backend();
  result.renderer = verifier.renderer();
  const Joint joint(a, b);
  clock.lap("prepare");

  context.report("search", 0.0);
  auto hypotheses = options.search == Search::Sweep ? run_sweep(a, b, options, context, result)
                                                    : run_esa(a, b, options, context, result);
  clock.lap("search");

  context.report("align", 0.5);
  const double t = joint.tolerance();
  const double diameter = std::max(a.diameter, b.diameter);
  const auto most = static_cast<std::size_t>(options.max_candidates);
  // Each pass costs more a hypothesis and keeps fewer.  A reach much wider than the sweep's error would pull in
  // surfaces beside the joint, the other wall of a thin piece above all; so would other facets at first.
  const std::array<Pass, 4> passes{{{{10.0 * t, 4.0 * t, 8, 120}, 300, true},
                                    {{8.0 * t, 3.0 * t, 12, 300}, 1500, true},
                                    {{6.0 * t, 2.0 * t, 20, 0}, 0, false},
                                    {{3.0 * t, 1.0 * t, 15, 0, true}, 0, false}}};
  const std::array<std::size_t, 4> kept{10 * most, 3 * most, most, most};
  for (std::size_t k = 0; k < passes.size(); ++k) {
    if (k > 0 && context.cancelled()) break;
    refine(hypotheses, joint, passes[k], context);
    hypotheses = distinct(hypotheses, b, diameter, kept[k]);
  }
  clock.lap("align");

  context.report("verify", 0.8);
  for (const auto& hypothesis : hypotheses) {
    Candidate candidate = verifier.candidate(hypothesis.pose, hypothesis.evidence, hypothesis.strength);
    candidate.facet_a = hypothesis.facet_a;
    candidate.facet_b = hypothesis.facet_b;
    result.candidates.push_back(candidate);
  }
  clock.lap("verify");
  result.cancelled = context.cancelled();
  if (!result.candidates.empty()) result.verdict = verdict_of(result.candidates.front().score);
  context.report("done", 1.0);
  return result;
}

}  // namespace rejoin::match
