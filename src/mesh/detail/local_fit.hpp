/// Planes and quadrics that fit points in one place.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::mesh::detail {

/// A plane through points in one place.
struct PlaneFit {
  glm::vec3 normal;  ///< unit direction of least spread, either way round
  float variation =
      0;  ///< share of the spread along it: 0 in a plane, 1/3 at most  \source Pauly, Gross and Kobbelt 2002 (surface variation)
};
PlaneFit fit_plane(const std::vector<glm::vec3>& points, std::span<const std::uint32_t> chosen);

/// Its normal.
glm::vec3 plane_normal(const std::vector<glm::vec3>& points, std::span<const std::uint32_t> chosen);

/// Root mean square distance along z of points from the quadric over x and y that fits them best.  The six numbers that it has
/// are taken off the count of points.
/// \param points  lengths near 1
/// \return 0 for fewer than 12 points
double quadric_residual(std::span<const glm::dvec3> points);

}  // namespace rejoin::mesh::detail
