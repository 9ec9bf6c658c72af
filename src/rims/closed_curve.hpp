/// Closed curves in space.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::rims {

/// A closed curve as a polygon, without a repeated end point.
using ClosedCurve = std::vector<glm::dvec3>;

/// Length of a closed curve.
double length_of(const ClosedCurve& curve);

/// Points at equal arc length along a closed curve, beginning with its first.
/// \pre count >= 3, the curve has a length
ClosedCurve resampled(const ClosedCurve& curve, std::size_t count);

/// The curves on a mesh along which a function of its vertices (linear between them) is 0.  They run so that positive
/// values lie on their left, seen from outside.  Curves that end at a hole of the mesh are left out.
/// \param values  one a vertex
std::vector<ClosedCurve> zero_curves(const mesh::Mesh& mesh, std::span<const float> values);

}  // namespace rejoin::rims
