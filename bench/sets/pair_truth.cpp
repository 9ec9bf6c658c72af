#include "pair_truth.hpp"

#include <algorithm>

#include "core/angle.hpp"
#include "mesh/point_index.hpp"
#include "mesh/samples.hpp"

namespace rejoin::bench {
namespace {

constexpr double kFoundAngle = 5 * kDegree;
constexpr double kFoundDisplacement = 0.02;
constexpr double kPreciseAngle = 1 * kDegree;
constexpr double kPreciseDisplacement = 0.005;
constexpr std::size_t kSamples = 20000;

bool within(const Deviation& off, double angle_rad, double displacement) {
  return off.angle_rad <= angle_rad && off.displacement <= displacement;
}

// Points of A that have B's surface opposite to them close by, at the true pose.
std::optional<glm::dvec3> contact_direction(const match::Fragment& a, const match::Fragment& b,
                                            const Rigid& pose) {
  const mesh::Samples of_a = mesh::sample_surface(a.coarse, kSamples);
  mesh::Samples of_b = mesh::sample_surface(b.coarse, kSamples);
  for (std::size_t k = 0; k < of_b.size(); ++k) {
    of_b.points[k] = glm::vec3(pose(glm::dvec3(of_b.points[k]) + b.coarse.origin) - a.coarse.origin);
    of_b.normals[k] = glm::vec3(pose.rotation * glm::dvec3(of_b.normals[k]));
  }
  const mesh::PointIndex index(of_b.points);
  const double reach = 2 * std::max(of_a.spacing, of_b.spacing);
  glm::dvec3 sum(0.0);
  for (std::size_t k = 0; k < of_a.size(); ++k) {
    const auto nearest = index.nearest(of_a.points[k]);
    if (!nearest || nearest->second > reach) continue;
    if (glm::dot(of_a.normals[k], of_b.normals[nearest->first]) > -0.7F) continue;
    sum += glm::dvec3(of_a.normals[k]);
  }
  const double length = glm::length(sum);
  if (!(length > 0)) return std::nullopt;
  return sum / length;
}

}  // namespace

PairTruth::PairTruth(const match::Fragment& a, const match::Fragment& b, const Rigid& pose)
    : pose_(pose), direction_(contact_direction(a, b, pose)) {
  constexpr std::size_t kMostPoints = 4000;
  const auto points_of = [](const mesh::Mesh& mesh) {
    std::vector<glm::dvec3> points;
    const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kMostPoints);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += step) {
      points.push_back(mesh.origin + glm::dvec3(mesh.vertices[v]));
    }
    return points;
  };
  points_ = points_of(b.surface);
  std::vector<glm::dvec3> both = points_of(a.surface);
  for (const glm::dvec3& p : points_) both.push_back(pose(p));
  glm::dvec3 low = both.front();
  glm::dvec3 high = low;
  for (const glm::dvec3& p : both) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  diameter_ = glm::length(high - low);
}

Deviation PairTruth::deviation(const Rigid& first, const Rigid& second) const {
  double sum = 0;
  for (const glm::dvec3& p : points_) sum += glm::length(first(p) - second(p));
  return {angle_between(first, second), sum / static_cast<double>(points_.size()) / diameter_};
}

bool PairTruth::right(const Rigid& pose) const {
  return within(deviation(pose, pose_), kFoundAngle, kFoundDisplacement);
}

bool PairTruth::precise(const Rigid& pose) const {
  return within(deviation(pose, pose_), kPreciseAngle, kPreciseDisplacement);
}

}  // namespace rejoin::bench
