#include "report/facet_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/words.hpp"
#include "report/canvas.hpp"
#include "report/numbered_picture.hpp"

namespace rejoin::report {

Colour facet_colour(int number, const mesh::Segmentation& facets) {
  if (number < 0) return {60, 60, 60};
  if (!facets.facets[static_cast<std::size_t>(number)].fracture) return {190, 190, 190};
  const double hue =
      std::fmod(number * 0.618033988749895, 1.0) * 6.0;  // the golden ratio keeps neighbours apart
  const auto channel = [hue](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    return static_cast<std::uint8_t>(255.0 * (0.95 - 0.8 * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0)));
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

Image facet_picture(const mesh::Mesh& surface, const mesh::Segmentation& facets, const std::string& title) {
  const auto fractures = std::count_if(facets.facets.begin(), facets.facets.end(),
                                       [](const mesh::Facet& facet) { return facet.fracture; });
  NumberedPicture what;
  what.title = title;
  what.part_of_face = mesh::facet_of_faces(facets, mesh::sample_of_faces(facets, surface));
  const bool rest = std::ranges::any_of(what.part_of_face, [](int facet) { return facet < 0; });
  what.subtitle = fmt::format(
      "{} in colour, original surface grey{}; {}",
      counted(static_cast<std::size_t>(fractures), "fracture facet"), rest ? ", in no facet dark" : "",
      facets.wall_thickness > 0 ? fmt::format("wall {} thick", short_number(facets.wall_thickness))
                                : std::string("solid"));
  what.colour = [&facets](int facet) { return facet_colour(facet, facets); };
  return numbered_picture(surface, what);
}

}  // namespace rejoin::report
