#include "assembly/evidence.hpp"

#include <algorithm>
#include <cmath>

#include "match/align.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kMost = 12.0;
constexpr double kDegree = 0.017453292519943295;

}  // namespace

double log_odds(double score) {
  if (!(score > 0.0)) return -kMost;
  if (score >= 1.0) return kMost;
  return std::clamp(std::log(score / (1.0 - score)), -kMost, kMost);
}

double contact_strength(const Piece& a, const Piece& b, const Rigid& b_to_a) {
  const Rigid from_file{glm::dmat3(1.0), -a.fragment().surface.origin};
  const Rigid to_file{glm::dmat3(1.0), b.fragment().surface.origin};
  const match::Joint joint(a.fragment(), b.fragment());
  return match::strength(joint.evidence(from_file * b_to_a * to_file, 0));
}

bool same_pose(const Piece& a, const Piece& b, const Rigid& first, const Rigid& second,
               const Options& options) {
  if (angle_between(first, second) > options.same_turn_deg * kDegree) return false;
  const double diameter = std::max(a.fragment().diameter, b.fragment().diameter);
  return glm::distance(first(b.centre()), second(b.centre())) <= options.same_shift * diameter;
}

}  // namespace rejoin::assembly
