/// How deep a point lies in a piece.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline::detail {

/// Signed distance to a piece's border on a grid: positive inside.  Accurate to about a cell.
class DistanceGrid {
 public:
  /// \param cell  side of a cell, file units, at most: there are 96 to 512 along the longer side of the piece
  DistanceGrid(const Outline& outline, double cell);

  /// Depth of a point, file units; far outside a negative number that is not exact.
  double depth(const glm::dvec2& point) const;

  /// Places spread evenly over the piece, the centres of some of the cells.
  const std::vector<glm::dvec2>& inside() const { return inside_; }

  /// What each of these places stands for.
  double area_of_place() const { return area_of_place_; }

 private:
  glm::dvec2 low_{0.0};
  double cell_ = 1.0;
  double area_of_place_ = 1.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> depths_;
  std::vector<glm::dvec2> inside_;
};

}  // namespace rejoin::outline::detail
