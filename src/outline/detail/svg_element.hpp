/// What the attributes of an element of SVG say.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace rejoin::outline::detail {

inline constexpr const char* kSvgMend = "draw the outlines as closed paths or polygons";

inline constexpr double kPixelsAnInch = 96.0;

/// The element's name without its namespace's prefix.
std::string local_name(const pugi::xml_node& node);

/// A property as the element's style has it, else its attribute; without blanks around it, empty if there is none.
std::string property(const pugi::xml_node& node, const char* name);

/// The element's transform, of its style or else its attribute.
/// \param path  for messages   \throws InputError it is broken, or in other units than px and deg
glm::dmat3 transform_of(const pugi::xml_node& node, const std::string& path);

/// A length with its unit.
struct Length {
  double value = 0.0;     ///< pixels of 1/96 inch, or a share of the reference
  bool physical = false;  ///< given in mm, cm, in, pt or pc
};

/// \param reference  100 %
/// \return nullopt: there is no such attribute
/// \throws InputError it is no length, or in a unit of the font
std::optional<Length> length_of(const pugi::xml_node& node, const char* name, double reference,
                                const std::string& path);

/// The view box of an <svg>: its lower and upper corner; without one, from the origin to its width and height.
struct ViewBox {
  glm::dvec2 low{0.0};
  glm::dvec2 high{0.0};  ///< not above low: unknown
};
/// \param around  size of what the element is in, for lengths in %
ViewBox view_box(const pugi::xml_node& svg, const glm::dvec2& around, const std::string& path);

/// The polygons that an element draws, in its own coordinates: paths, polygons, rectangles, circles and ellipses.  Those of paths and
/// polygons that are closed there end at their first points.
/// \param around  size of what the element is in, for lengths in %
/// \throws InputError what it says is broken
std::vector<std::vector<glm::dvec2>> polygons_of(const pugi::xml_node& node, const glm::dvec2& around,
                                                 const std::string& path);

}  // namespace rejoin::outline::detail
