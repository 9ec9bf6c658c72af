#include "match/refine.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "core/angle.hpp"
#include "core/parallel.hpp"
#include "match/cuts.hpp"
#include "match/esa_search.hpp"
#include "match/stability.hpp"
#include "match/verify.hpp"

namespace rejoin::match {
namespace {

constexpr std::size_t kEvenIfCancelled = 6;
constexpr std::array kTighter{0.7, 0.5, 0.35};  // reaches, tolerances
constexpr double kUnbacked = 0.9;               // share of the contact
constexpr double kSkin = 4.0;                   // patches: less goes on at wrong poses, too
constexpr double kLeastTouching = 0.82;         // of what lies over the other surface, what touches
constexpr double kLeastAgreement = 0.18;        // nats a patch: gaps vary by 0.84 of what the surfaces do
// The poses of one pair of facets take one of so many parts of the places that go on; the last one of so many parts is for pairs of
// facets that have no place yet.
constexpr std::size_t kShare = 3;
constexpr std::size_t kFirsts = 4;
constexpr int kHalvings = 40;
constexpr double kNoLimit = -std::numeric_limits<double>::infinity();
constexpr double kFirm =
    0.3;  // Stability::slide and elsewhere of the best pose beside which those that slide are no rivals

constexpr double kTurned = 15.0 * kDegree;  // from the best pose: no place of the same contact farther along

void sort_by_rank(std::vector<Hypothesis>& list) {
  std::stable_sort(list.begin(), list.end(), [](const Hypothesis& x, const Hypothesis& y) {
    return rank(x.evidence) > rank(y.evidence);
  });
}

void take_if_stronger(const Rigid& pose, const Joint& joint, Hypothesis& hypothesis) {
  const auto evidence = joint.agreed_evidence_above(hypothesis.strength, pose);
  if (!evidence || strength(*evidence) <= hypothesis.strength) return;
  hypothesis.pose = pose;
  hypothesis.evidence = *evidence;
  hypothesis.strength = strength(*evidence);
}

void tighten_one(Hypothesis& hypothesis, const Joint& joint) {
  const double t = joint.tolerance();
  const Rigid start = hypothesis.pose;
  for (const double reach : kTighter) {
    take_if_stronger(joint.align(start, {1.0 * t, reach * t, 15, 0, true}), joint, hypothesis);
  }
}

/// Whether a pose is none of those in the list.
bool is_new(const Hypothesis& hypothesis, const glm::dvec3& centre, double diameter,
            const std::vector<Hypothesis>& list) {
  return std::ranges::none_of(list, [&](const Hypothesis& other) {
    return same_pose(other.pose, hypothesis.pose, centre, diameter);
  });
}

/// The facets of both pieces that poses come from, as users see them: what is one facet there may be several elsewhere.
class PairsOfFacets {
 public:
  PairsOfFacets(const Fragment& a, const Fragment& b) : a_(a), b_(b) {}

  std::pair<int, int> of(const Hypothesis& hypothesis) {
    return {seen(a_, hypothesis.facet_a, seen_a_), seen(b_, hypothesis.facet_b, seen_b_)};
  }

 private:
  static int seen(const Fragment& fragment, int facet, std::map<int, int>& known) {
    const auto [place, is_new] = known.try_emplace(facet, -1);
    if (is_new && facet >= 0) place->second = seen_facet(fragment, facet);
    return place->second;
  }

  const Fragment& a_;
  const Fragment& b_;
  std::map<int, int> seen_a_;
  std::map<int, int> seen_b_;
};

/// With less information where only large, smooth shape agrees, loosely.
Evidence told(const Evidence& evidence, const Joint& joint, const Rigid& pose) {
  return strength(evidence) > 0.0 ? told_by_scale(evidence, joint.scales(pose)) : evidence;
}

/// What holds a pose back as it stands.
Doubt doubt_of(const Evidence& evidence, bool solid) {
  if (may_be_walls(evidence)) return Doubt::Walls;
  if (solid && lies_loosely(evidence)) return Doubt::Loose;
  if (hardly_agrees(evidence)) return Doubt::Faint;
  return drifts(evidence) ? Doubt::Drift : Doubt::None;
}

}  // namespace

std::vector<Pass> passes(double tolerance, int most) {
  const double t = tolerance;
  const auto kept = static_cast<std::size_t>(most);
  // A reach much wider than the sweep's error would pull in surfaces beside the joint, the other wall of a thin piece above
  // all; so would other facets at first.  Once it lies there, the rest of a splintery break tells what a splinter alone cannot.
  const auto rough = [&](double from, double to, int iterations, int samples) {
    return AlignOptions{.reach_start = from * t,
                        .reach_end = to * t,
                        .iterations = iterations,
                        .most_samples = samples,
                        .quick = true,
                        .both = true};
  };
  return {{rough(10.0, 4.0, 8, 120), true, 300, true, 16 * kept},
          {rough(8.0, 3.0, 12, 300), true, 1500, false, 5 * kept},
          {{6.0 * t, 2.0 * t, 20, 0}, false, 0, false, 3 * kept, true},
          {{3.0 * t, 1.0 * t, 15, 0, true}, false, 0, false, 3 * kept}};
}

void refine(std::vector<Hypothesis>& list, const Joint& joint, const Pass& pass, const Context& context) {
  std::vector<char> done(list.size(), 0);
  parallel_for(list.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (context.cancelled() && k >= kEvenIfCancelled) continue;
      Hypothesis& hypothesis = list[k];
      AlignOptions options = pass.align;
      options.facet_a = pass.facet_aligned ? hypothesis.facet_a : -1;
      options.facet_b = pass.facet_aligned ? hypothesis.facet_b : -1;
      if (pass.facet_aligned && hypothesis.facet_a < 0)
        options.both = false;  // all there is would draw a laid pose far
      const int weighed_facet = pass.facet_weighed ? hypothesis.facet_b : -1;
      const bool all = pass.evidence_samples == 0 && !pass.facet_weighed;
      const auto weighed = [&](double above, const Rigid& pose) {
        return all ? joint.agreed_evidence_above(above, pose)
                   : joint.evidence_above(above, pose, {pass.evidence_samples, weighed_facet, options.quick});
      };
      const Rigid moved = joint.align(hypothesis.pose, options);
      const Evidence after = *weighed(kNoLimit, moved);
      const double worth = strength(after);
      const auto before = weighed(worth, hypothesis.pose);
      const bool moves = !before || worth >= strength(*before);
      if (moves) hypothesis.pose = moved;
      hypothesis.evidence = moves ? after : *before;
      hypothesis.strength = strength(hypothesis.evidence);
      done[k] = 1;
    }
  });
  std::vector<Hypothesis> kept;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (done[k] != 0) kept.push_back(list[k]);
  }
  list.swap(kept);
  sort_by_rank(list);
}

std::vector<Hypothesis> distinct(const std::vector<Hypothesis>& list, const Fragment& b, double diameter) {
  const glm::dvec3 centre = mesh::centroid(b.surface);
  std::vector<Hypothesis> kept;
  for (const auto& hypothesis : list)
    if (is_new(hypothesis, centre, diameter, kept)) kept.push_back(hypothesis);
  return kept;
}

std::vector<Hypothesis> shortlist(const std::vector<Hypothesis>& list, const Fragment& a, const Fragment& b,
                                  std::size_t most) {
  const glm::dvec3 centre = mesh::centroid(b.surface);
  const double diameter = std::min(a.diameter, b.diameter);
  const std::size_t share = std::max<std::size_t>(1, most / kShare);
  const std::size_t shared = most - most / kFirsts;
  PairsOfFacets facets(a, b);
  std::map<std::pair<int, int>, std::size_t> taken;
  std::vector<Hypothesis> kept;
  std::vector<Hypothesis> waiting;  // within the share of their pair of facets
  std::vector<Hypothesis> beyond;
  const auto wait = [&](const Hypothesis& hypothesis, std::vector<Hypothesis>& queue) {
    if (queue.size() >= most || !is_new(hypothesis, centre, diameter, queue)) return false;
    queue.push_back(hypothesis);
    return true;
  };
  for (const auto& hypothesis : list) {
    if (kept.size() == most) break;
    if (!is_new(hypothesis, centre, diameter, kept)) continue;
    std::size_t& of_these = taken[facets.of(hypothesis)];
    const bool within = of_these < share;
    if (of_these == 0 || (within && kept.size() < shared)) {
      kept.push_back(hypothesis);
    } else if (!wait(hypothesis, within ? waiting : beyond)) {
      continue;
    }
    ++of_these;
  }
  waiting.insert(waiting.end(), beyond.begin(), beyond.end());
  for (const auto& hypothesis : waiting) {
    if (kept.size() == most) break;
    if (is_new(hypothesis, centre, diameter, kept)) kept.push_back(hypothesis);
  }
  sort_by_rank(kept);
  return kept;
}

void tighten(std::vector<Hypothesis>& list, const Joint& joint, const Fragment& b, double diameter) {
  parallel_for(list.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      if (k == 0 || score_of(list[k].strength) >= kPossible) tighten_one(list[k], joint);
    }
  });
  sort_by_rank(list);
  list = distinct(list, b, diameter);
}

bool may_be_walls(const Evidence& evidence) {
  return evidence.unbacked_area > kUnbacked * evidence.contact_area && evidence.continuation < kSkin;
}

bool lies_loosely(const Evidence& evidence) {
  return touching_share(evidence) < kLeastTouching && evidence.continuation < kSkin;
}

bool hardly_agrees(const Evidence& evidence) {
  const double patches = evidence.shared_area / std::max(evidence.patch_area, 1e-300);
  return std::max(evidence.information, evidence.near_information) < kLeastAgreement * patches;
}

Evidence at_most_even(Evidence evidence, Doubt doubt) {
  evidence.doubt = doubt;
  if (strength(evidence) <= kEven) return evidence;
  const auto with = [&](double part) {
    Evidence held = evidence;
    held.information = part * evidence.information;
    held.near_information = part * evidence.near_information;
    return held;
  };
  double low = 0.0;  // strength is no line in it: of what counts within twice the distances 6 is taken off
  double high = 1.0;
  for (int step = 0; step < kHalvings; ++step) {
    const double part = 0.5 * (low + high);
    (strength(with(part)) <= kEven ? low : high) = part;
  }
  return with(low);
}

Weighed weigh(const Evidence& evidence, const Joint& joint, const Rigid& pose) {
  const Evidence all = told(evidence, joint, pose);
  const bool solid = joint.thickness() <= 0.0;
  const Doubt doubt = doubt_of(all, solid);
  if (doubt != Doubt::None) return {at_most_even(all, doubt), strength(all)};
  return {solid ? with_fewer_patches(all) : all, strength(all)};
}

void weigh(std::vector<Hypothesis>& list, const Joint& joint) {
  parallel_for(list.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Hypothesis& hypothesis = list[k];
      const Weighed weighed = weigh(hypothesis.evidence, joint, hypothesis.pose);
      hypothesis.fit = hypothesis.strength;
      hypothesis.as_rival = std::min(hypothesis.strength, weighed.as_rival);
      hypothesis.evidence = weighed.evidence;
      hypothesis.strength = std::min(hypothesis.strength, strength(hypothesis.evidence));
    }
  });
  sort_by_rank(list);
}

std::optional<Stability> hold_sliding(Evidence& evidence, const Joint& joint, const Rigid& pose) {
  const auto stability = probe(joint, pose, evidence);
  if (!stability || !slides(*stability)) return stability;
  evidence.continuation = 0.0;  // of what is drawn along a line the skin goes on wherever it lies
  evidence = at_most_even(evidence, Doubt::Slide);
  return stability;
}

void probe_likely(std::vector<Hypothesis>& list, const Joint& joint, const Context& context) {
  parallel_for(list.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Hypothesis& hypothesis = list[k];
      if (hypothesis.as_rival <= kEven || context.cancelled()) continue;
      hypothesis.stability = hold_sliding(hypothesis.evidence, joint, hypothesis.pose);
      hypothesis.strength = std::min(hypothesis.strength, strength(hypothesis.evidence));
    }
  });
  sort_by_rank(list);
}

double strongest_rival(const std::vector<Hypothesis>& list) {
  if (list.empty()) return 0.0;
  const Hypothesis& best = list.front();
  const bool firm = best.stability && best.stability->slide < kFirm && best.stability->elsewhere < kFirm;
  const auto strength_of = [&](const Hypothesis& rival) {
    const bool elsewhere = angle_between(best.pose, rival.pose) > kTurned;
    return firm && elsewhere && rival.evidence.doubt == Doubt::Slide ? rival.strength : rival.as_rival;
  };
  double most = 0.0;
  for (std::size_t k = 1; k < list.size(); ++k) most = std::max(most, strength_of(list[k]));
  return most;
}

void settle(std::vector<Hypothesis>& list, const Joint& joint, const Fragment& b, double diameter) {
  const double t = joint.tolerance();
  parallel_for(list.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Hypothesis& hypothesis = list[k];
      if (score_of(hypothesis.strength) < kPossible) continue;
      const Rigid aligned = joint.align(hypothesis.pose, {.reach_start = 2.0 * t,
                                                          .reach_end = 0.7 * t,
                                                          .iterations = 15,
                                                          .most_samples = 0,
                                                          .core_only = true,
                                                          .both = true});
      const Evidence open = joint.agreed_evidence(aligned);
      hypothesis.pose = Rigid{glm::dmat3(1.0), -open.gap_middle * open.normal} * aligned;
      const bool doubted = hypothesis.evidence.doubt != Doubt::None;
      hypothesis.evidence = weigh(joint.agreed_evidence(hypothesis.pose), joint, hypothesis.pose).evidence;
      if (doubted && hypothesis.evidence.doubt == Doubt::None)
        hypothesis.strength = std::min(hypothesis.as_rival, strength(hypothesis.evidence));
    }
  });
  list = distinct(list, b, diameter);
}

}  // namespace rejoin::match
