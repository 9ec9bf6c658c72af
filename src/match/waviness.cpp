#include "match/waviness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "match/detail/shape.hpp"
#include "mesh/neighbours.hpp"

namespace rejoin::match {
namespace {

constexpr double kRadius = 1.5;       // wall thicknesses, three patches of a joint (JointLengths::patch)
constexpr double kLeastRadius = 7.5;  // spacings, three patches of solid pieces
constexpr std::size_t kPlaces = 300;
constexpr std::size_t kLeastPlaces = 5;
constexpr double kSurrounded = 0.7;  // of a disc's area, by surface
constexpr float kAlike = 0.7F;       // normals differ by at most 45 degrees
constexpr std::size_t kShare = 10;   // one of so many places is smoother

}  // namespace

double waviness(const mesh::Segmentation& facets) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const bool solid = facets.wall_thickness <= 0;
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;
  for (std::size_t i = 0; i < facets.samples.size(); ++i) {
    if (!solid && facets.surface[i] != mesh::Surface::Original) continue;
    points.push_back(facets.samples.points[i]);
    normals.push_back(facets.normals[i]);
  }
  if (points.empty()) return kUnknown;
  const double radius = std::max(kRadius * facets.wall_thickness, kLeastRadius * facets.samples.spacing);
  const double enough = kSurrounded * std::numbers::pi * radius * radius / facets.sample_area;
  const mesh::Neighbours neighbours(points, static_cast<float>(radius));
  std::vector<double> deviations;
  std::vector<std::uint32_t> near;
  std::vector<glm::dvec3> around;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kPlaces)) {
    neighbours.of(points[i], near);
    around.clear();
    for (const std::uint32_t j : near)
      if (glm::dot(normals[i], normals[j]) > kAlike) around.emplace_back(points[j]);
    if (around.size() < 12 || static_cast<double>(around.size()) < enough) continue;
    deviations.push_back(
        detail::robust_deviation(detail::heights_above_quadric(around, glm::dvec3(normals[i]), 1)));
  }
  if (deviations.size() < kLeastPlaces) return kUnknown;
  const auto at = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / kShare);
  std::nth_element(deviations.begin(), at, deviations.end());
  return *at;
}

}  // namespace rejoin::match
