/// The path data of SVG ("M 0 0 L ...") as polygons.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rejoin::outline::detail {

/// Subpaths with their curves cut into straight pieces; each counts as closed, but those that end with Z end at their first points.
/// \param problem  gets what is wrong where the answer is nullopt
std::optional<std::vector<std::vector<glm::dvec2>>> flatten_path(std::string_view data, std::string& problem);

/// The numbers of a list such as points="0,0 1,0"; nullopt: something else is in it.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

}  // namespace rejoin::outline::detail
