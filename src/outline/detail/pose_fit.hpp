/// Poses of a flat piece by non-linear least squares.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline::detail {

/// A point of B and where on A it should lie.
struct PointPair {
  glm::dvec2 on_a{0.0};
  glm::dvec2 on_b{0.0};
  glm::dvec2 normal{
      0.0};  ///< of A's border there, unit length; zero: the distance counts the same in all directions
};

/// Turn and shift of B that minimise the sum of squared distances (of pairs with a normal: the distance along it, and a
/// tenth of that across it), by Levenberg and Marquardt's method.
/// \param start  supplies the first values and whether B lies upside down
/// \pre at least 2 pairs, not all of one point
/// \source naiman 2018, section 7.2
Planar fit_pose(const std::vector<PointPair>& pairs, const Planar& start);

/// A first pose from three of the pairs: the first, the middle and the last.
Planar pose_of_three(const std::vector<PointPair>& pairs, bool flipped);

}  // namespace rejoin::outline::detail
