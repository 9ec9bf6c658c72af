/// From where a joint is looked at.
#pragma once

#include <vector>

#include "report/joint.hpp"
#include "report/renderer.hpp"

namespace rejoin::report {

inline constexpr Colour kTintA{214, 172, 128};  ///< warm
inline constexpr Colour kTintB{132, 166, 202};  ///< cool; told apart by all common kinds of colour blindness

/// Both fragments where they belong, in their tints.
std::vector<Body> joined_bodies(const Joint& joint);

/// Both fragments pulled apart along the joint's normal and each turned towards the eye about the joint's
/// long axis, like the
/// covers of a book, so that both broken faces can be seen.
std::vector<Body> opened_bodies(const Joint& joint, const glm::dvec3& back);

/// Three directions towards the eye: from the side that shows most, across the seam (it runs through the
/// picture), along it (end on).
struct JointViews {
  glm::dvec3 best;
  glm::dvec3 across;
  glm::dvec3 along;
};
JointViews choose_views(const Joint& joint, const Scene& joined);

/// Up in a picture seen from `back`, such that the way from A to B runs to the right where that is possible.
glm::dvec3 up_for(const Joint& joint, const glm::dvec3& back);

}  // namespace rejoin::report
