/// The rim of a sherd: where broken surface meets original surface.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "match/match.hpp"

namespace rejoin::rims {

/// One place of a rim.
struct RimPoint {
  glm::dvec3 place{0.0};  ///< relative to the mesh's origin
  glm::dvec3 along{0.0};  ///< unit, forward: the original surface is on the left, seen from outside
  glm::dvec3 wall{0.0};   ///< unit, outward normal of the original surface, perpendicular to `along`
  double turn = 0.0;      ///< of `along` within the wall a step, radians, positive to the left: curvature
  double bend = 0.0;      ///< of `along` towards `wall` a step, radians
  double twist = 0.0;     ///< of `wall` about `along` a step, radians: torsion
  double thickness =
      0.0;  ///< distance to the rim of the opposite wall, mesh units, at most three walls; 0: solid piece
};

/// A closed rim, sampled evenly.
struct Rim {
  std::vector<RimPoint> points;
  double step = 0.0;  ///< mesh units, nearly the wanted one
};

/// The rims of a fragment, longest first; those below a tenth of the longest are left out.  A thin sherd has two, one on
/// either wall.  Empty where nothing is broken, or nothing whole.
/// \param step       between points, mesh units
/// \param smoothing  of the curve, standard deviation, in steps
std::vector<Rim> find_rims(const match::Fragment& fragment, double step, double smoothing);

}  // namespace rejoin::rims
