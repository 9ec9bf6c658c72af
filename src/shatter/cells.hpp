/// Which piece a point of space belongs to.
#pragma once

#include <vector>

#include "shatter/noise.hpp"

namespace rejoin::shatter {

/// Voronoi cells with rough walls: the planes between the sites, bent by noise.  Both neighbours of a wall see
/// the same wall.
struct Cells {
  std::vector<glm::dvec3> sites;
  Noise warp;

  /// Distance from a point to the walls of one cell: the two nearest, and whose cell is behind the nearest.
  struct Walls {
    double nearest = -1e300;  ///< signed, below 0 inside the cell; mesh units, exact where there is no noise
    double second = -1e300;
    int behind = -1;  ///< -1: there is no other cell
  };
  Walls walls(const glm::dvec3& point, std::size_t cell) const;

  /// Where a point is seen by the sites.
  glm::dvec3 bent(const glm::dvec3& point) const { return point + warp.at(point); }

  /// The cell that holds a point, bent already.  \pre there are sites
  std::size_t cell_of(const glm::dvec3& bent_point) const;
};

}  // namespace rejoin::shatter
