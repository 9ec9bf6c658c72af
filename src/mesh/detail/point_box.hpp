/// Boxes of points of which a few may lie far from the rest.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace rejoin::mesh::detail {

struct PointBox {
  glm::dvec3 low;
  glm::dvec3 high;

  double size() const { return glm::length(high - low); }
};

inline constexpr double kFar = 4.0;  ///< sizes of the box of most points, which no scan reaches beyond it

/// \pre there are points
PointBox box_of_all(const std::vector<glm::dvec3>& points);

/// On each axis between the shares 0.02 and 0.98 of up to some 10,000 of the points.
PointBox box_of_most(const std::vector<glm::dvec3>& points);

/// Box of the points but for a few far from the rest, which some writers put at zero for those that they could not measure.
PointBox box_of_piece(const std::vector<glm::dvec3>& points);

}  // namespace rejoin::mesh::detail
