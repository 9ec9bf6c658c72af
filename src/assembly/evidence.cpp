#include "assembly/evidence.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kMostOdds = 12.0;

}  // namespace

double log_odds(double score) {
  if (!(score > 0.0)) return -kMostOdds;
  if (score >= 1.0) return kMostOdds;
  return std::clamp(std::log(score / (1.0 - score)), -kMostOdds, kMostOdds);
}

bool same_pose(const Piece& a, const Piece& b, const Rigid& first, const Rigid& second,
               const Options& options, double times) {
  if (angle_between(first, second) > times * options.same_turn_deg * kDegree) return false;
  const double diameter = std::min(a.fragment().diameter, b.fragment().diameter);
  return glm::distance(first(b.centre()), second(b.centre())) <= times * options.same_shift * diameter;
}

}  // namespace rejoin::assembly
