/// Style sheets of a drawing.
#pragma once

#include <pugixml.hpp>

namespace rejoin::outline::detail {

/// Writes what the drawing's style sheets say of its elements into their style attributes, before what these say themselves
/// ("!important" behind it).  Selectors may name elements, classes, ids and several of these at once ("path.a, #b, *").
/// \return whether a rule is left that hides or moves shapes and has another selector
bool apply_style_sheets(const pugi::xml_node& root);

}  // namespace rejoin::outline::detail
