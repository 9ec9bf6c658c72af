#include "match/paint.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "core/words.hpp"
#include "match/waviness.hpp"
#include "mesh/painted_facets.hpp"

namespace rejoin::match {

std::optional<std::vector<std::string>> paint(Fragment& fragment, const std::string& file,
                                              const mesh::Mesh& painted) {
  if (painted.is_cloud() || painted.colours.empty()) {
    throw InputError(file, painted.is_cloud() ? "has no faces" : "has no colours",
                     "paint the file that rejoin facets SCAN --ply writes");
  }
  auto facets = mesh::painted_facets(fragment.facets, fragment.surface.origin, painted);
  if (!facets) return std::nullopt;
  if (std::ranges::none_of(facets->segmentation.facets, &mesh::Facet::fracture))
    throw InputError(file, "has no break painted", "give every break a colour; grey is original surface");
  fragment.facets = std::move(facets->segmentation);
  fragment.waviness = waviness(fragment.facets, fragment.diameter, fragment.resolution);
  std::vector<std::string> told;
  if (facets->left_out > 0) {
    told.push_back(fmt::format("{}: {} on too little of the surface to be a facet, left out", file,
                               counted(facets->left_out, "colour")));
  }
  return told;
}

}  // namespace rejoin::match
