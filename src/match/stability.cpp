#include "match/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "match/refine.hpp"

namespace rejoin::match {
namespace {

constexpr double kPush = 3.0;  // tolerances by which the pose is moved
constexpr double kFar = 16.0;  // and by which it is moved to another place
constexpr double kDegrees = 57.29577951308232;
constexpr double kStays = 0.25;  // share of that distance that is left where it does not go back
constexpr int kFewest = 24;      // samples: an alignment by half of them takes 12

/// Stability::elsewhere.
/// \param on_b   a point of B, in the joint
/// \param along  Joint::least_held()
double left_elsewhere(const Joint& joint, const Rigid& pose, const glm::dvec3& on_b,
                      const glm::dvec3& along) {
  const double t = joint.tolerance();
  const auto worth = [&joint](const Rigid& at) {
    return weigh(joint.agreed_evidence(at), joint, at).as_rival;
  };
  const double here = worth(pose);
  double most = 0.0;
  for (const double side : {-1.0, 1.0}) {
    const Rigid pushed = Rigid{glm::dmat3(1.0), side * kFar * t * along} * pose;
    const Rigid end = joint.align(pushed, {2.0 * kPush * t, 1.0 * t, 15, 0});
    const bool went_back = glm::dot(end(on_b) - pose(on_b), side * along) < kStays * kFar * t;
    if (!went_back) most = std::max(most, worth(end));
  }
  return here > 0.0 ? most / here : 0.0;
}

}  // namespace

std::optional<Stability> probe(const Joint& joint, const Rigid& pose, const Evidence& evidence) {
  if (evidence.core_samples < kFewest) return std::nullopt;
  const double t = joint.tolerance();
  AlignOptions options{3.0 * t, 1.0 * t, 15, 0, true};
  const glm::dvec3 on_b = inverse(pose)(evidence.centre);
  std::array<Rigid, 2> halves;
  for (options.half = 0; options.half < 2; ++options.half) {
    halves[static_cast<std::size_t>(options.half)] = joint.align(pose, options);
  }

  Stability stability;
  stability.repeat_deg = kDegrees * angle_between(halves[0], halves[1]);
  stability.repeat_shift = glm::distance(halves[0](on_b), halves[1](on_b));
  const glm::dvec3 along = joint.least_held(pose, t);
  options = {2.0 * kPush * t, 1.0 * t, 15, 0};
  std::array<double, 2> ends{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double push = (k == 0 ? -kPush : kPush) * t;
    const Rigid moved = Rigid{glm::dmat3(1.0), push * along} * pose;
    ends[k] = glm::dot(joint.align(moved, options)(on_b) - evidence.centre, along);
  }
  stability.slide = std::min(1.0, std::abs(ends[1] - ends[0]) / (2.0 * kPush * t));
  stability.elsewhere = left_elsewhere(joint, pose, on_b, along);
  return stability;
}

}  // namespace rejoin::match
