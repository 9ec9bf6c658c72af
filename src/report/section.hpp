/// A cut through placed meshes.
#pragma once

#include <vector>

#include "report/canvas.hpp"
#include "report/joint.hpp"

namespace rejoin::report {

/// A plane with axes: position (x, y) stands for origin + x * right + y * up.
struct Plane {
  glm::dvec3 origin{0.0};
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 1, 0};
};

/// Where the surface of a placed mesh meets a plane, as lines in the plane's axes.  A closed mesh gives closed lines
/// (first point = last point), and so does one with slits narrower than 1 % of the cut; an open one may give open lines.
/// \param pose  file coordinates -> the plane's frame
std::vector<std::vector<glm::dvec2>> section(const mesh::Mesh& mesh, const Rigid& pose, const Plane& plane);

/// Both fragments cut through the joint, filled where they are closed, with a scale in mesh units.
Image draw_section(const Joint& joint, int width, int height);

}  // namespace rejoin::report
