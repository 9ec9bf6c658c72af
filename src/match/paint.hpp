/// A fragment's facets as a user painted them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "match/match.hpp"

namespace rejoin::match {

/// Gives the fragment the facets of a painted surface (mesh::painted_facets()), if that lies on it; else nothing changes.
/// \param file     of the painted surface, for messages
/// \param painted  as it was loaded (mesh::Weld::PlacesAndColours)
/// \return what to tell the user; nullopt if it lies elsewhere
/// \throws InputError it has no faces or no colours, or no break is painted
std::optional<std::vector<std::string>> paint(Fragment& fragment, const std::string& file,
                                              const mesh::Mesh& painted);

}  // namespace rejoin::match
