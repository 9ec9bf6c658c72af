#include "match/stability.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::match {
namespace {

constexpr double kPush = 3.0;  // tolerances by which the pose is moved along the seam
constexpr double kDegrees = 57.29577951308232;

double turn_deg(const glm::dmat3& from, const glm::dmat3& to) {
  const glm::dmat3 turn = to * glm::transpose(from);
  const double cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0);
  return kDegrees * std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

Stability probe(const Joint& joint, const Rigid& pose, const Evidence& evidence) {
  const double t = joint.tolerance();
  AlignOptions options{3.0 * t, 1.0 * t, 15, 0, true};
  const glm::dvec3 on_b = inverse(pose)(evidence.centre);
  options.half = 0;
  const Rigid even = joint.align(pose, options);
  options.half = 1;
  const Rigid odd = joint.align(pose, options);

  Stability stability;
  stability.repeat_deg = turn_deg(even.rotation, odd.rotation);
  stability.repeat_shift = glm::distance(even(on_b), odd(on_b));
  options = {2.0 * kPush * t, 1.0 * t, 15, 0};
  for (const double push : {-kPush * t, kPush * t}) {
    const Rigid moved = Rigid{glm::dmat3(1.0), push * evidence.along} * pose;
    const glm::dvec3 left = joint.align(moved, options)(on_b) - evidence.centre;
    stability.slide = std::max(stability.slide, std::abs(glm::dot(left, evidence.along) / push));
  }
  return stability;
}

}  // namespace rejoin::match
