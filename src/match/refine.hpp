/// Many rough poses become a few aligned ones.
#pragma once

#include <optional>
#include <vector>

#include "core/context.hpp"
#include "match/align.hpp"

namespace rejoin::match {

/// A pose on its way through the stages; relative to the meshes' origins.
struct Hypothesis {
  Rigid pose;
  Evidence evidence;
  double strength = 0;  ///< of the joint where it was aligned
  int facet_a = -1;     ///< match/cuts.hpp; -1: not from a facet
  int facet_b = -1;
  double as_rival =
      0;  ///< the same without what weigh() holds back: of ridges in grooves, equal poses may lie on both sides of a limit
  double fit = 0;                                     ///< strength before it was weighed
  std::optional<Stability> stability = std::nullopt;  ///< where it was probed
};

/// One round of alignment over all hypotheses that are left.
struct Pass {
  AlignOptions align;
  bool facet_aligned = false;  ///< by the facet of B alone that the hypothesis came from
  int evidence_samples = 0;    ///< of B that are looked at; 0: all
  bool facet_weighed = false;  ///< of that facet alone
  std::size_t kept = 0;        ///< distinct poses that go on
  bool sparse = false;         ///< by Joint::sparse()
};

/// The rounds of a match, first to last; each costs more a hypothesis and keeps fewer.
/// \param tolerance  Joint::tolerance(), mesh units
/// \param most       poses that are asked for in the end; three times as many are left, as weigh() puts some of the first last
std::vector<Pass> passes(double tolerance, int most);

/// Aligns every hypothesis, moves it where that does not weaken it (what shape a small contact has may not hold it), and sorts
/// by rank().  After a cancel only the first few still are, so that
/// what was found is not lost; the others are dropped.
void refine(std::vector<Hypothesis>& list, const Joint& joint, const Pass& pass, const Context& context);

/// Of poses that are the same the first.
/// \param diameter  of the smaller fragment, mesh units
std::vector<Hypothesis> distinct(const std::vector<Hypothesis>& list, const Fragment& b, double diameter);

/// The first `most` of a list that are different poses, but of one pair of facets a third of them as long as there are
/// others, and in the last quarter one each of pairs that have none yet: where sawn or moulded faces lie on each other,
/// all their poses look better than that of a small break, and two plates' sides make four pairs.
/// \pre sorted by refine()
std::vector<Hypothesis> shortlist(const std::vector<Hypothesis>& list, const Fragment& a, const Fragment& b,
                                  std::size_t most);

/// Aligns the first, and all others that may be a join, again with shorter reaches and takes what is stronger, for how far
/// worn places have to be left out differs from joint to joint; then sorts, and keeps one of poses that came together.
/// \param diameter  of the smaller fragment, mesh units
/// \pre sorted by refine()
void tighten(std::vector<Hypothesis>& list, const Joint& joint, const Fragment& b, double diameter);

/// Whether hardly anything lies behind the contact in either scan, and no skin goes on across its border: it may be the walls of two
/// sherds that were scanned from one side.
bool may_be_walls(const Evidence& evidence);

/// Whether much of what lies over the other surface does not touch it, and no skin goes on across the border of the contact: solid pieces
/// with rounded outsides lie in each other's hollows like that.
bool lies_loosely(const Evidence& evidence);

/// Whether a large contact tells by its size alone: of the shape of each patch hardly any agrees, as where sawn or tooled faces lie on each
/// other and the best of many poses fits their marks a little.
bool hardly_agrees(const Evidence& evidence);

/// The evidence with that doubt, and at most as much information as leaves a joint as likely as not.
Evidence at_most_even(Evidence evidence, Doubt doubt);

/// The evidence of a pose, weighed.
struct Weighed {
  Evidence evidence;
  double as_rival = 0;  ///< Hypothesis::as_rival
};

/// The evidence of a pose with less information where it would say too much: where only large, smooth shape agrees, loosely
/// (told_by_scale()), where gaps drift (with_fewer_patches()), and where what touches may be walls, solid pieces lie loosely on each other, hardly any shape agrees, or gaps drift by more than the scans explain: such a joint is
/// at most as likely as not.
/// \param evidence  joint.agreed_evidence(pose)
/// \source docs/scoring.md
Weighed weigh(const Evidence& evidence, const Joint& joint, const Rigid& pose);

/// Weighs the poses that are left, then sorts.
/// \pre tightened
void weigh(std::vector<Hypothesis>& list, const Joint& joint);

/// Probes a pose; one along which one piece slides is at most as likely as not then.
/// \param evidence  weigh()ed
/// \return as probe()
std::optional<Stability> hold_sliding(Evidence& evidence, const Joint& joint, const Rigid& pose);

/// Probes the poses that would be likelier than not, and holds those back along which one piece slides: what is drawn along a line, as run
/// mouldings and flutes are, lies in its like anywhere.  Then sorts.
/// \pre settled
void probe_likely(std::vector<Hypothesis>& list, const Joint& joint, const Context& context);

/// The largest strength as a rival of all but the first; 0 if there are none.  Beside a first pose that holds firmly, one that slides,
/// turned against it, is a rival by what was not held back alone: it is another contact, not the same one farther along.
/// \pre weighed, and probed
double strongest_rival(const std::vector<Hypothesis>& list);

/// Aligns what may be a join by both pieces' samples at once, and shifts it along its normal until the median of its gaps, signed
/// and away from edges, is nought; the strength stays: false poses gain as much, and where a joint is strongest it is not nearest to the
/// truth, as more of worn edges touches if they are pressed into each other.  What held a pose back no more does where it has settled: a
/// large joint that is turned a little drifts.  Keeps one of poses that came together.
/// \param diameter  of the smaller fragment, mesh units
/// \pre weighed
void settle(std::vector<Hypothesis>& list, const Joint& joint, const Fragment& b, double diameter);

}  // namespace rejoin::match
