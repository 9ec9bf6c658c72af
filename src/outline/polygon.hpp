/// Whether a polygon can be an outline, and repairs.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rejoin::outline {

/// \param subject  file and place for messages
/// \throws InputError a coordinate is not finite, or beyond 1e12: areas and what is reckoned with them would overflow
void require_usual_points(const std::vector<glm::dvec2>& polygon, const std::string& subject);

/// Whether a point lies inside a closed polygon (even-odd rule; either answer on the border itself).
bool contains(const std::vector<glm::dvec2>& polygon, const glm::dvec2& point);

/// A point inside a closed polygon: the middle of the widest part of the level line half way up that is inside; the first corner if
/// there is none.
glm::dvec2 inner_point(const std::vector<glm::dvec2>& polygon);

/// The same of a piece with holes.
/// \param rings  its border, then the holes; at least one
glm::dvec2 inner_point(const std::vector<std::vector<glm::dvec2>>& rings);

/// Shares (0..1) of the way from a to b and from c to d at which the two segments meet; nullopt: nowhere, or they are
/// parallel.
std::optional<glm::dvec2> meeting(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                                  const glm::dvec2& d);

/// Two edges of a closed polygon that cross or touch without being neighbours, with the point; edge i runs from point i to
/// the next.  The pair with the least first edge; nullopt: the polygon is simple.  About n log n for outlines of even
/// edges.
struct Crossing {
  std::size_t first = 0;
  std::size_t second = 0;
  glm::dvec2 point{0.0};
};
std::optional<Crossing> find_crossing(const std::vector<glm::dvec2>& polygon);

/// How far apart the ends of a line are that may be an outline of which a part is missing: several times its longest edge, and a
/// share of its length.  nullopt: closing it adds an edge like the others.
std::optional<double> open_ends(const std::vector<glm::dvec2>& line);

/// The same as a sentence for the user.
std::optional<std::string> doubt_ends(const std::vector<glm::dvec2>& line);

/// Makes an outline of a closed polygon: takes out repeated points, cuts off small loops where it crosses itself, and
/// turns it so that its area is positive; the first point stays the first.
/// \param subject  file and place for messages
/// \param notes    gets a sentence for each repair
/// \throws InputError fewer than 4 distinct points are left (a triangle tells nothing of where it broke), a point is not
///                    usual, the area is 0, or a loop holds more than 2 % of the area
std::vector<glm::dvec2> mend_polygon(std::vector<glm::dvec2> polygon, const std::string& subject,
                                     std::vector<std::string>& notes);

}  // namespace rejoin::outline
