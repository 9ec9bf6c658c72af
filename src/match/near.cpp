#include "match/near.hpp"

#include <cmath>

#include "core/angle.hpp"
#include "match/evidence.hpp"

namespace rejoin::match {
namespace {

constexpr double kTilt_deg = 15.0;  // of two facets against each other at a true joint, at most

/// The farthest that a turn about `centre` within the limits moves a vertex.
double farthest_turned(const mesh::Mesh& surface, const glm::dvec3& centre) {
  double radius = 0.0;
  for (const glm::vec3& vertex : surface.vertices)
    radius = std::max(radius, glm::distance(glm::dvec3(vertex), centre));
  return 2.0 * std::sin(0.5 * Near::kTurn_deg * kDegree) * radius;
}

mesh::Box box_at(const mesh::Mesh& surface, const Rigid& pose) {
  std::vector<glm::vec3> points;
  points.reserve(surface.vertices.size());
  for (const glm::vec3& vertex : surface.vertices) points.emplace_back(pose(vertex));
  return mesh::bounds(points);
}

}  // namespace

Near::Near(const Fragment& a, const Fragment& b, const Rigid& in_files)
    : pose_(to_origins(a, b, in_files)),
      centre_b_(mesh::centroid(b.surface)),
      shift_(kShift * std::min(a.diameter, b.diameter)) {
  centre_ = pose_(centre_b_);
}

bool Near::holds(const Rigid& pose) const {
  return angle_between(pose, pose_) <= kTurn_deg * kDegree &&
         glm::distance(pose(centre_b_), centre_) <= shift_;
}

bool Near::may_become(const glm::dmat3& rotation) const {
  return angle_between({rotation, {}}, pose_) <= (kTurn_deg + kTilt_deg) * kDegree;
}

bool may_touch(const Fragment& a, const Fragment& b, const Rigid& in_files) {
  const mesh::Box box_a = mesh::bounds(a.surface);
  const mesh::Box box_b = box_at(b.surface, to_origins(a, b, in_files));
  const glm::vec3 apart = glm::max(glm::max(box_a.low - box_b.high, box_b.low - box_a.high), glm::vec3(0.0F));
  const double bridged = Near::kShift * std::min(a.diameter, b.diameter) +
                         farthest_turned(b.surface, mesh::centroid(b.surface)) +
                         kOver * contact_tolerance(a, b, Breaks::Worn);
  return static_cast<double>(glm::length(apart)) <= bridged;
}

}  // namespace rejoin::match
