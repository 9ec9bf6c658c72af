#include "report/views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace rejoin::report {
namespace {

constexpr double kOpening = 38;      ///< degrees that each fragment turns towards the eye
constexpr double kClearance = 0.06;  ///< between the opened fragments, share of the larger diameter
constexpr int kDirections = 80;
constexpr int kLookSide = 72;  ///< pixels across a trial view

/// Lowest and highest position of a body along a direction.
std::pair<double, double> span_along(const Body& body, const glm::dvec3& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const glm::vec3& vertex : body.mesh->vertices) {
    const double at = glm::dot(body.pose(body.mesh->origin + glm::dvec3(vertex)), direction);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return {low, high};
}

Rigid about(const glm::dvec3& point, const glm::dmat3& rotation) {
  return {rotation, point - rotation * point};
}

/// The turn that brings `facing` towards `back`.
glm::dmat3 opening_turn(const glm::dvec3& facing, const glm::dvec3& back) {
  return axis_rotation(glm::normalize(glm::cross(facing, back)), glm::radians(kOpening));
}

/// Even directions (Fibonacci lattice).
glm::dvec3 direction_of(int k) {
  const double z = 1 - (2 * k + 1.0) / kDirections;
  const double turn = 2 * std::numbers::pi * std::fmod(k * (std::numbers::phi - 1), 1.0);
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(turn), radius * std::sin(turn), z};
}

/// How much a view tells: object seen, both fragments seen, seam seen; each about 0 .. 1.
double informativeness(const Visibility& seen) {
  std::array<double, 2> share{0, 0};
  int seam = 0;
  for (int y = 0; y + 1 < seen.height; ++y) {
    for (int x = 0; x + 1 < seen.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * seen.width + x;
      const int body = seen.body[at];
      if (body < 0) continue;
      share[body] += 1;
      for (const std::size_t next : {at + 1, at + seen.width}) seam += seen.body[next] == 1 - body ? 1 : 0;
    }
  }
  const double covered = share[0] + share[1];
  if (covered <= 0) return 0;
  const double area = covered / (static_cast<double>(seen.width) * seen.height);
  const double balance = 2 * std::min(share[0], share[1]) / covered;
  return 1.5 * area + balance + static_cast<double>(seam) / seen.width;
}

}  // namespace

std::vector<Body> joined_bodies(const Joint& joint) {
  return {{&joint.a, Rigid{}, kTintA, {}, {}}, {&joint.b, joint.pose, kTintB, {}, {}}};
}

std::vector<Body> opened_bodies(const Joint& joint, const glm::dvec3& back) {
  std::vector<Body> bodies = joined_bodies(joint);
  bodies[0].pose = about(joint.centre, opening_turn(joint.normal, back)) * bodies[0].pose;
  bodies[1].pose = about(joint.centre, opening_turn(-joint.normal, back)) * bodies[1].pose;
  const double clear = kClearance * std::max(mesh::diameter(joint.a), mesh::diameter(joint.b));
  const double middle = glm::dot(joint.centre, joint.normal);
  const double right_of_a = span_along(bodies[0], joint.normal).second;
  const double left_of_b = span_along(bodies[1], joint.normal).first;
  bodies[0].pose.translation += (middle - clear / 2 - right_of_a) * joint.normal;
  bodies[1].pose.translation += (middle + clear / 2 - left_of_b) * joint.normal;
  return bodies;
}

glm::dvec3 up_for(const Joint& joint, const glm::dvec3& back) {
  const glm::dvec3 up = glm::cross(back, joint.normal);
  return glm::length(up) > 0.2 ? glm::normalize(up) : joint.along;
}

JointViews choose_views(const Joint& joint, const Scene& joined) {
  const auto worth = [&](const glm::dvec3& back) {
    return informativeness(joined.look(joined.overview(back, up_for(joint, back)), kLookSide, kLookSide));
  };
  const auto better = [&](const glm::dvec3& direction) {
    return worth(direction) >= worth(-direction) ? direction : -direction;
  };
  JointViews views{};
  views.across = better(joint.across);
  views.along = better(joint.along);
  constexpr double kApart = 0.87;  // cosine: the third view differs by 30 degrees from the others
  double most = -1;
  for (int k = 0; k < kDirections; ++k) {
    const glm::dvec3 back = direction_of(k);
    const bool repeated =
        std::abs(glm::dot(back, views.across)) > kApart || std::abs(glm::dot(back, views.along)) > kApart;
    if (repeated || std::abs(glm::dot(back, joint.normal)) > kApart) continue;
    const double value = worth(back);
    if (value > most) {
      most = value;
      views.best = back;
    }
  }
  return views;
}

}  // namespace rejoin::report
