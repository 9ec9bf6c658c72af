#include "assembly/evidence.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "match/judge.hpp"
#include "match/refine.hpp"
#include "match/stability.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kMostOdds = 12.0;

match::Evidence judged(const match::Joint& joint, const Rigid& at) {
  const match::Evidence evidence = match::weigh(joint.agreed_evidence(at), joint, at);
  if (match::strength(evidence) <= match::kEven) return evidence;
  const auto stability = match::probe(joint, at, evidence);
  return stability && match::slides(*stability) ? match::at_most_even(evidence) : evidence;
}

}  // namespace

double log_odds(double score) {
  if (!(score > 0.0)) return -kMostOdds;
  if (score >= 1.0) return kMostOdds;
  return std::clamp(std::log(score / (1.0 - score)), -kMostOdds, kMostOdds);
}

match::Evidence contact_evidence(const Piece& a, const Piece& b, const Rigid& b_to_a) {
  const match::Joint fresh(a.fragment(), b.fragment());
  const Rigid at = match::to_origins(a.fragment(), b.fragment(), b_to_a);
  const match::Evidence evidence = judged(fresh, at);
  if (!match::tell_wear(a.fragment(), b.fragment()) || match::fits(fresh, at)) return evidence;
  const match::Evidence worn = judged(fresh.worn(), at);
  return match::strength(worn) > match::strength(evidence) ? worn : evidence;
}

bool same_pose(const Piece& a, const Piece& b, const Rigid& first, const Rigid& second,
               const Options& options) {
  if (angle_between(first, second) > options.same_turn_deg * kDegree) return false;
  const double diameter = std::min(a.fragment().diameter, b.fragment().diameter);
  return glm::distance(first(b.centre()), second(b.centre())) <= options.same_shift * diameter;
}

}  // namespace rejoin::assembly
