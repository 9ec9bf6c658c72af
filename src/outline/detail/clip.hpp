/// Areas of polygons (Clipper behind it): union, intersection, difference, offset.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace rejoin::outline::detail {

using Polygon = std::vector<glm::dvec2>;
/// Outer borders with positive shoelace area, holes negative.
using Region = std::vector<Polygon>;

/// Coordinates are kept to 1e-9 of the larger region's extent.  Self-crossing polygons are taken by the non-zero rule.
Region unite(const Region& a, const Region& b);
Region intersect(const Region& a, const Region& b);
Region subtract(const Region& a, const Region& b);

/// Grown by `distance` (shrunk if negative), with round corners.
/// \param arc_tolerance  how far a round corner may be off, in the polygons' unit
Region offset(const Region& region, double distance, double arc_tolerance);

/// Area of all borders less the holes.
double area_of(const Region& region);

/// The border with the largest area; empty if there is none.
Polygon largest(const Region& region);

}  // namespace rejoin::outline::detail
