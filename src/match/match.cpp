#include "match/match.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/angle.hpp"
#include "core/stopwatch.hpp"
#include "match/align.hpp"
#include "match/constraints.hpp"
#include "match/cuts.hpp"
#include "match/esa_search.hpp"
#include "match/near.hpp"
#include "match/refine.hpp"
#include "match/stability.hpp"
#include "match/sweep.hpp"
#include "match/verify.hpp"

namespace rejoin::match {
namespace {

constexpr std::size_t kGlance = 2;  // rounds of alignment after which poses are about as strong as in the end
constexpr const char* kWalls =
    "what touches has nothing behind it in either scan, so it may be the walls of sherds that were scanned "
    "from one side: the score is 0.5 at most; "
    "scan the other side, too, or paint the breaks (rejoin facets)";
constexpr double kFacetSpread_deg =
    25.0;  // how far a facet's mean normal may lie from the direction that a user sees

/// Breaks, of a piece that has any: walls join nothing.
bool may_join(const Fragment& fragment, const mesh::Facet& facet) {
  const std::vector<mesh::Facet>& all = fragment.facets.facets;
  return facet.fracture || all.empty() || !all.front().fracture;
}

/// Facets of both cuts that face one of the directions, or the one of each cut that comes closest.
std::vector<int> facets_facing(const Fragment& fragment, const std::vector<glm::dvec3>& directions,
                               double tolerance_deg) {
  std::vector<int> list;
  const FacetNumbers numbers = facet_numbers(fragment);
  const std::array cuts{std::pair(0, numbers.creased), std::pair(numbers.creased, numbers.end)};
  const double limit = std::cos((tolerance_deg + kFacetSpread_deg) * kDegree);
  for (const auto& direction : directions) {
    for (const auto& [first, end] : cuts) {
      int closest = -1;
      double best = -2.0;
      for (int f = first; f < end; ++f) {
        if (!may_join(fragment, facet(fragment, f))) continue;
        const double cosine = glm::dot(facet(fragment, f).normal, glm::normalize(direction));
        if (cosine > limit) list.push_back(f);
        if (cosine <= best) continue;
        best = cosine;
        closest = f;
      }
      if (closest >= 0) list.push_back(closest);
    }
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

/// What to tell of directions that no facet faces: the sweep searches the closest ones, the annealing what lies there.
void doubt_directions(const Fragment& fragment, const std::vector<glm::dvec3>& directions,
                      double tolerance_deg, std::vector<std::string>& warnings) {
  for (const glm::dvec3& direction : directions) {
    double closest = -1.0;
    for (const mesh::Facet& facet : fragment.facets.facets)
      if (may_join(fragment, facet))
        closest = std::max(closest, glm::dot(facet.normal, glm::normalize(direction)));
    const double off_deg = std::acos(std::min(closest, 1.0)) / kDegree;
    if (off_deg <= tolerance_deg + kFacetSpread_deg) continue;
    warnings.push_back(fmt::format(
        "{}: no break faces {:.3g},{:.3g},{:.3g}; the closest one is {:.0f} degrees off: directions "
        "point out of the piece, in its file's axes (see rejoin facets)",
        fragment.path, direction.x, direction.y, direction.z, off_deg));
  }
}

void doubt_facets(const Fragment& fragment, const std::vector<int>& chosen,
                  std::vector<std::string>& warnings) {
  for (const int number : chosen) {
    if (may_join(fragment, facet(fragment, number))) continue;
    warnings.push_back(
        fmt::format("{}: its facet {} is original surface, which joins nothing: if it is a break, paint it "
                    "(rejoin facets, --facets)",
                    fragment.path, number));
  }
}

void doubt_wishes(const Fragment& a, const Fragment& b, const Options& options,
                  std::vector<std::string>& warnings) {
  doubt_directions(a, options.directions_a, options.tolerance_deg, warnings);
  doubt_directions(b, options.directions_b, options.tolerance_deg, warnings);
  doubt_facets(a, options.facets_a, warnings);
  doubt_facets(b, options.facets_b, warnings);
}

std::vector<int> allowed_facets(const Fragment& fragment, const std::vector<int>& chosen,
                                const std::vector<glm::dvec3>& directions, const Options& options) {
  if (!chosen.empty()) return in_both_cuts(fragment, chosen);
  return facets_facing(fragment, directions, options.tolerance_deg);
}

/// Whether the material's axes, if they are known, are that far off each other at most.
bool axes_agree(const Rigid& pose, const Options& options, double most_deg) {
  if (!options.material_a || !options.material_b) return true;
  const double cosine = std::abs(
      glm::dot(glm::normalize(*options.material_a), pose.rotation * glm::normalize(*options.material_b)));
  return cosine >= std::cos(most_deg * kDegree);
}

/// For what the sweep or the rims propose, which the alignment still turns.
bool axes_may_agree(const Rigid& pose, const Options& options) {
  return axes_agree(pose, options, options.tolerance_deg + 10.0);
}

/// Whether the axes say which poses are told; beside directions they only bias the annealing (figure 11).
bool axes_restrict(const Options& options) {
  return options.search == Search::Sweep || plan_constraints(options).material == MaterialUse::Restrict;
}

/// Leaves out what the alignment turned off the material's axes, and tells the best of it that may be a join.
void keep_axes(std::vector<Hypothesis>& hypotheses, const Options& options,
               std::vector<std::string>& warnings) {
  const auto off = [&](const Hypothesis& h) { return !axes_agree(h.pose, options, options.tolerance_deg); };
  const auto best = std::ranges::find_if(hypotheses, off);
  if (best == hypotheses.end()) return;
  if (score_of(best->strength) >= kPossible) {
    warnings.push_back(fmt::format(
        "a pose with a score of {:.2f} was left out: the material's axes are more than {:.3g} degrees "
        "off each other there (--tolerance)",
        score_of(best->strength), options.tolerance_deg));
  }
  std::erase_if(hypotheses, off);
}

std::vector<Hypothesis> run_sweep(const Fragment& a, const Fragment& b, const Options& options,
                                  const std::optional<Near>& near, const Context& context, Result& result) {
  SweepOptions sweep_options;
  sweep_options.facets_a = allowed_facets(a, options.facets_a, options.directions_a, options);
  sweep_options.facets_b = allowed_facets(b, options.facets_b, options.directions_b, options);
  sweep_options.near = near;
  const SweepResult swept = sweep(a, b, sweep_options, context);
  result.evaluations = swept.evaluations;
  std::vector<Hypothesis> hypotheses;
  for (const auto& hit : swept.hits) {
    if (axes_may_agree(hit.pose, options))
      hypotheses.push_back({hit.pose, {}, 0.0, hit.facet_a, hit.facet_b});
  }
  return hypotheses;
}

std::vector<Hypothesis> proposed(const Fragment& a, const Fragment& b, const Options& options) {
  std::vector<Hypothesis> hypotheses;
  for (const Rigid& proposal : options.proposals) {
    const Rigid pose = to_origins(a, b, proposal);
    if (axes_may_agree(pose, options)) hypotheses.push_back({pose, {}, 0.0, -1, -1});
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
    hypotheses.push_back({to_origins(a, b, found.pose), {}, 0.0, found.facet_a, found.facet_b});
  }
  result.evaluations = stats.evaluations;
  result.convergence = std::move(stats.convergence);
  result.warnings.insert(result.warnings.end(), stats.warnings.begin(), stats.warnings.end());
  return hypotheses;
}

void keep_near(std::vector<Hypothesis>& hypotheses, const Near& near) {
  const auto far = [&](const Hypothesis& hypothesis) { return !near.holds(hypothesis.pose); };
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), far), hypotheses.end());
}

/// \param near  what has moved away from it is dropped
void align(std::vector<Hypothesis>& hypotheses, const Joint& joint, const Fragment& a, const Fragment& b,
           const std::optional<Near>& near, std::span<const Pass> rounds, const Context& context) {
  for (const Pass& pass : rounds) {
    if (pass.sparse) {
      refine(hypotheses, joint.sparse(), pass, context);
    } else {
      refine(hypotheses, joint, pass, context);
    }
    if (near) keep_near(hypotheses, *near);
    hypotheses = shortlist(hypotheses, a, b, pass.kept);
    if (context.cancelled()) break;
  }
}

/// Puts the pose that the user has laid, aligned, among as many others as are told besides, by its rank: others in reach may look better, but
/// it stays.
/// \param fresh  by whose distances it is aligned: the larger ones of worn breaks would move it far
void keep_laid(std::vector<Hypothesis>& hypotheses, const Joint& joint, const Fragment& a, const Fragment& b,
               const Near& near, const Joint& fresh, const Options& options, const Context& context) {
  std::vector<Hypothesis> laid{{near.pose(), {}, 0.0, -1, -1}};
  align(laid, fresh, a, b, near, passes(fresh.tolerance(), options.max_candidates), context);
  if (laid.empty() || options.max_candidates < 2) return;
  hypotheses.resize(std::min(hypotheses.size(), static_cast<std::size_t>(options.max_candidates) - 1));
  if (&joint != &fresh) {
    laid.front().evidence = joint.agreed_evidence(laid.front().pose);
    laid.front().strength = strength(laid.front().evidence);
  }
  const double worth = rank(laid.front().evidence);
  const auto place =
      std::ranges::find_if(hypotheses, [&](const Hypothesis& other) { return rank(other.evidence) < worth; });
  hypotheses.insert(place, laid.front());
}

/// The largest strength, 0 without any; it need not be the first's, as poses are sorted by rank().
double strongest(std::span<const Hypothesis> hypotheses) {
  double most = 0.0;
  for (const Hypothesis& hypothesis : hypotheses) most = std::max(most, hypothesis.strength);
  return most;
}

/// What the poses of a pair come to, judged in one way.
struct Judgement {
  Breaks breaks = Breaks::Fresh;
  std::vector<Hypothesis> hypotheses;  ///< as many as are asked for
  std::optional<Stability> stability;  ///< of the first
  std::vector<std::string> warnings;
  double promise = 0;      ///< Result::promise
  bool in_full = true;     ///< Result::in_full
  bool has_a_fit = false;  ///< some pose is as strong as a sure one before anything is held back

  double strength() const { return hypotheses.empty() ? 0.0 : hypotheses.front().strength; }
};

Judgement judged(std::vector<Hypothesis> hypotheses, const Joint& joint, const Joint& fresh,
                 const Fragment& a, const Fragment& b, const std::optional<Near>& near,
                 const Options& options, const Context& context) {
  Judgement result;
  const auto rounds = passes(joint.tolerance(), options.max_candidates);
  align(hypotheses, joint, a, b, near, std::span(rounds).first(kGlance), context);
  result.promise = strongest(hypotheses);
  if (options.promising_only && result.promise < (both_thin(a, b) ? kWorthwhileThin : kWorthwhile)) {
    result.in_full = false;
    result.hypotheses = std::move(hypotheses);
    return result;
  }
  if (!context.cancelled()) align(hypotheses, joint, a, b, near, std::span(rounds).subspan(kGlance), context);
  if (near && !context.cancelled()) keep_laid(hypotheses, joint, a, b, *near, fresh, options, context);
  if (!context.cancelled()) tighten(hypotheses, joint, b, std::min(a.diameter, b.diameter));
  weigh(hypotheses, joint);
  if (!context.cancelled()) settle(hypotheses, joint, b, std::min(a.diameter, b.diameter));
  if (near) keep_near(hypotheses, *near);
  if (axes_restrict(options)) keep_axes(hypotheses, options, result.warnings);
  probe_likely(hypotheses, joint, context);
  const double next = strongest_rival(hypotheses);
  result.has_a_fit = std::ranges::any_of(
      hypotheses, [](const Hypothesis& hypothesis) { return score_of(hypothesis.fit) >= kSure; });
  hypotheses.resize(std::min(hypotheses.size(), static_cast<std::size_t>(options.max_candidates)));
  if (!hypotheses.empty() && !context.cancelled()) {
    const Hypothesis& best = hypotheses.front();
    result.stability = best.stability ? best.stability : probe(joint, best.pose, best.evidence);
    if (result.stability) {
      result.stability->margin = log_odds(best.strength) - log_odds(next);
      if (best.strength > 0.0) result.stability->next_share = next / best.strength;
    }
  }
  result.hypotheses = std::move(hypotheses);
  return result;
}

/// As fresh breaks, and where these fit nowhere, as worn ones.  Breaks that fit by the smaller distances and are doubted, as they slide,
/// drift, agree in large shape alone or fit at several poses, are not asked again by distances that hide it.
Judgement judged_both_ways(std::vector<Hypothesis> hypotheses, const Fragment& a, const Fragment& b,
                           const Joint& joint, const std::optional<Near>& near, const Options& options,
                           const Context& context) {
  Judgement fresh = judged(hypotheses, joint, joint, a, b, near, options, context);
  if (!tell_wear(a, b) || fresh.has_a_fit || context.cancelled()) return fresh;
  Judgement worn = judged(std::move(hypotheses), joint.worn(), joint, a, b, near, options, context);
  worn.breaks = Breaks::Worn;
  worn.promise = fresh.promise = std::max(fresh.promise, worn.promise);
  const bool better = fresh.in_full == worn.in_full ? worn.strength() > fresh.strength() : worn.in_full;
  return better && !context.cancelled() ? worn : fresh;
}

/// Ends with the best pose so far, if there is one.
void give_up(const Fragment& a, const Fragment& b, const std::vector<Hypothesis>& hypotheses,
             const Context& context, Result& result) {
  result.in_full = false;
  result.cancelled = context.cancelled();
  if (hypotheses.empty()) return;
  const Hypothesis& best = hypotheses.front();
  Candidate candidate = unmeasured(a, b, best.pose, best.evidence, best.strength);
  candidate.facet_a = seen_facet(a, best.facet_a);
  candidate.facet_b = seen_facet(b, best.facet_b);
  result.candidates.push_back(candidate);
}

}  // namespace

const char* name_of(Breaks breaks) {
  return breaks == Breaks::Worn ? "worn" : "fresh";
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Join:
      return "join";
    case Verdict::Unsure:
      return "unsure";
    case Verdict::NoJoin:
      break;
  }
  return "no join";
}

Result match(const Fragment& a, const Fragment& b, const Options& options, const Context& context) {
  Result result;
  Stopwatch clock(result.stages);
  Verifier verifier(a, b, options);
  result.backend = verifier.backend();
  result.renderer = verifier.renderer();
  const Joint joint(a, b);
  clock.lap("prepare");

  context.report("search", 0.0);
  std::optional<Near> near;
  if (options.near) near.emplace(a, b, *options.near);
  if (options.proposals.empty()) doubt_wishes(a, b, options, result.warnings);
  auto hypotheses = !options.proposals.empty()        ? proposed(a, b, options)
                    : options.search == Search::Sweep ? run_sweep(a, b, options, near, context, result)
                                                      : run_esa(a, b, options, context, result);
  if (near) {
    keep_near(hypotheses, *near);
    hypotheses.push_back({near->pose(), {}, 0.0, -1, -1});
  }
  clock.lap("search");

  context.report("align", 0.5);
  const Judgement best = judged_both_ways(std::move(hypotheses), a, b, joint, near, options, context);
  result.promise = best.promise;
  result.breaks = best.breaks;
  if (!best.in_full) {
    clock.lap("align");
    give_up(a, b, best.hypotheses, context, result);
    return result;
  }
  result.stability = best.stability;
  result.warnings.insert(result.warnings.end(), best.warnings.begin(), best.warnings.end());
  clock.lap("align");

  context.report("verify", 0.8);
  for (const auto& hypothesis : best.hypotheses) {
    Candidate candidate = verifier.candidate(hypothesis.pose, hypothesis.evidence, hypothesis.strength);
    candidate.facet_a = seen_facet(a, hypothesis.facet_a);
    candidate.facet_b = seen_facet(b, hypothesis.facet_b);
    result.candidates.push_back(candidate);
  }
  clock.lap("verify");
  result.cancelled = context.cancelled();
  if (!result.candidates.empty()) {
    result.verdict = verdict_of(result.candidates.front().score, result.stability);
    result.against =
        against(best.hypotheses.front().evidence, result.candidates.front().score, result.stability);
    if (result.verdict != Verdict::NoJoin && may_be_walls(best.hypotheses.front().evidence))
      result.warnings.emplace_back(kWalls);
  }
  context.report("done", 1.0);
  return result;
}

}  // namespace rejoin::match
