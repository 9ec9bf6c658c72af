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

constexpr double kRadius = 1.5;    // wall thicknesses, three patches of a joint (JointLengths::patch)
constexpr double kOfSize = 0.15;   // of the piece: as the walls of a small sherd of a thick vessel
constexpr double kSpacings = 7.5;  // of samples or of the scan's points, three patches of solid pieces
constexpr std::size_t kPlaces = 1000;
constexpr std::size_t kLeastPlaces = 5;
constexpr double kSurrounded = 0.7;  // of a disc's area, by surface
constexpr float kAlike = 0.7F;       // normals differ by at most 45 degrees
constexpr double kFilled =
    0.002;  // spacings: no scanner made what is smoother, as a hole that was filled or a table's cut
constexpr std::size_t kShare = 4;  // one of so many places is smoother

}  // namespace

double waviness(const mesh::Segmentation& facets, double size, double resolution) {
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
  const double spacing = std::max(facets.samples.spacing, resolution);
  const double radius =
      std::max(std::min(kRadius * facets.wall_thickness, kOfSize * size), kSpacings * spacing);
  const double enough = kSurrounded * std::numbers::pi * radius * radius / facets.sample_area;
  const mesh::Neighbours neighbours(points, static_cast<float>(radius));
  std::vector<double> deviations;
  std::vector<std::uint32_t> near;
  std::vector<glm::dvec3> around;
  for (std::size_t i = 0; i < points.size(); i += 1 + (points.size() - 1) / kPlaces) {
    neighbours.of(points[i], near);
    around.clear();
    for (const std::uint32_t j : near)
      if (glm::dot(normals[i], normals[j]) > kAlike) around.emplace_back(points[j]);
    if (around.size() < 12 || static_cast<double>(around.size()) < enough) continue;
    const double deviation =
        detail::robust_deviation(detail::heights_above_quadric(around, glm::dvec3(normals[i]), 1));
    if (deviation > kFilled * facets.samples.spacing) deviations.push_back(deviation);
  }
  if (deviations.size() < kLeastPlaces) return kUnknown;
  const auto at = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / kShare);
  std::nth_element(deviations.begin(), at, deviations.end());
  return *at;
}

}  // namespace rejoin::match
