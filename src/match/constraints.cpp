#include "match/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.hpp"
#include "core/error.hpp"
#include "match/silhouette.hpp"

namespace rejoin::match {
namespace {

// A range must not be empty; a hundredth of a degree is far below what a depth map shows.
constexpr double kLeastAngle = 1.7e-4;
const glm::dvec3 kZ(0, 0, 1);

void require_length(const glm::dvec3& axis, const char* option) {
  const double length = glm::length(axis);
  if (!(length > 0) || !std::isfinite(length)) {
    throw InputError(option, "direction of length 0", "give three numbers that are not all zero");
  }
}

std::vector<anneal::Variable> variables_of(double reach, const anneal::Variable& tilt_a,
                                           const anneal::Variable& tilt_b) {
  const anneal::Variable shift{-reach, reach, false};
  const anneal::Variable turn{0, kTurn, true};
  return {tilt_a, tilt_a, turn, shift, shift, tilt_b, tilt_b};
}

}  // namespace

ConstraintPlan plan_constraints(const Options& options) {
  for (const glm::dvec3& d : options.directions_a) require_length(d, "--direction-a");
  for (const glm::dvec3& d : options.directions_b) require_length(d, "--direction-b");
  if (options.material_a) require_length(*options.material_a, "--material-a");
  if (options.material_b) require_length(*options.material_b, "--material-b");
  if (!(options.tolerance_deg >= 0 && options.tolerance_deg <= 45)) {
    throw InputError("--tolerance", "out of range", "give 0 to 45 degrees");
  }
  const bool axes = options.material_a && options.material_b;
  if (!axes && (options.material_a || options.material_b)) {
    throw InputError(options.material_a ? "--material-b" : "--material-a", "missing",
                     "give both axes or none");
  }
  if (!axes && options.constraint == Constraint::Material) {
    throw InputError("--constraint material", "no material axes", "give --material-a and --material-b");
  }
  ConstraintPlan plan;
  plan.directions = options.constraint == Constraint::Direction || !options.directions_a.empty() ||
                    !options.directions_b.empty() || !options.facets_a.empty() || !options.facets_b.empty();
  if (axes) plan.material = plan.directions ? MaterialUse::Bias : MaterialUse::Restrict;
  return plan;
}

zbuffer::ViewPair SearchSpace::view(std::span<const double> point) const {
  PoseVector pose;
  std::copy(point.begin(), point.end(), pose.begin());
  if (locked) {
    pose[kTheta2] = -point[kTheta1] + point[kTheta2];
    pose[kPhi2] = point[kPhi1] + kTurn / 2 + point[kPhi2];
  }
  if (!shift_of_rho.empty()) {
    const auto count = shift_of_rho.size();
    const double place = (pose[kRho1] / kTurn - std::floor(pose[kRho1] / kTurn)) * static_cast<double>(count);
    const auto below = static_cast<std::size_t>(place) % count;
    const double part = place - std::floor(place);
    const glm::dvec2 shift = glm::mix(shift_of_rho[below], shift_of_rho[(below + 1) % count], part);
    pose[kX1] += shift.x;
    pose[kY1] += shift.y;
  }
  return view_of(pose, alignment, order);
}

SearchSpace free_space(double reach) {
  SearchSpace space;
  const anneal::Variable turn{0, kTurn, true};
  space.variables = variables_of(reach, turn, turn);
  return space;
}

SearchSpace direction_space(const glm::dvec3& direction_a, const glm::dvec3& direction_b,
                            double tolerance_rad, double reach) {
  const double most = std::max(tolerance_rad, kLeastAngle);
  SearchSpace space;
  const anneal::Variable tilt{-most, most, false};
  space.variables = variables_of(reach, tilt, tilt);
  space.alignment.rotation_a = rotation_between(glm::normalize(direction_a), kZ);
  space.alignment.rotation_b = rotation_between(glm::normalize(direction_b), kZ);
  return space;
}

SearchSpace material_space(const glm::dvec3& axis_a, const glm::dvec3& axis_b, double jitter_rad,
                           double reach, bool opposite) {
  const double most = std::max(jitter_rad, kLeastAngle);
  SearchSpace space;
  space.variables = variables_of(reach, {0, kTurn, true}, {-most, most, false});
  space.alignment.rotation_a = rotation_between(glm::normalize(axis_a), kZ);
  space.alignment.rotation_b = rotation_between(glm::normalize(axis_b), opposite ? -kZ : kZ);
  space.order = RotationOrder::ZFirst;
  space.locked = true;
  return space;
}

void centre_on_silhouettes(SearchSpace& space, zbuffer::Scorer& scorer, double view_side, int samples) {
  std::vector<glm::dvec2> shifts;
  std::optional<glm::dvec2> last_px;
  space.shift_of_rho.clear();
  // The first of two rounds tells what the first shift of the second one must lie near, as that is mixed with the last one, too.
  for (int k = 0; k < 2 * samples; ++k) {
    PoseVector pose{};
    pose[kRho1] = kTurn * (k % samples) / samples;
    const auto [a, b] = scorer.depth_maps(space.view(pose));
    // Between two rotations shifts are mixed: on from one to the next they must not jump across a hole.
    last_px = best_silhouette_shift(a, b, last_px).shift_px;
    if (k >= samples) shifts.push_back(*last_px * (view_side / a.width));
  }
  space.shift_of_rho = std::move(shifts);
}

EnergyRule at_resolution(EnergyRule rule, int resolution) {
  if (resolution < kFineMap)
    rule.least_pixels = rule.least_pixels * resolution * resolution / (kFineMap * kFineMap);
  return rule;
}

double energy(const zbuffer::PairScore& score, const zbuffer::ViewPair& view, const EnergyRule& rule) {
  const double least = rule.least_overlap * std::min(score.covered_a, score.covered_b);
  if (score.overlap < rule.least_pixels || score.overlap < least)
    return std::numeric_limits<double>::infinity();
  const double fit = (rule.overlap_bias ? zbuffer::overlap_bias(score) : 1.0) * score.error;
  if (!rule.material_axes) return fit;
  const glm::dvec3 axis_a = glm::dmat3(view.rotation_a) * rule.material_axes->first;
  const glm::dvec3 axis_b = glm::dmat3(view.rotation_b) * rule.material_axes->second;
  // B faces A after half a turn about Y.
  const double cosine = glm::dot(axis_a, glm::dvec3(-axis_b.x, axis_b.y, -axis_b.z));
  return (1 - rule.material_weight) * fit + rule.material_weight * (1 - std::min(1.0, std::abs(cosine)));
}

}  // namespace rejoin::match
