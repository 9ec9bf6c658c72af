/// Colours that fragments are told apart by, on pictures and on the page.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "report/image.hpp"

namespace rejoin::report {

/// Quiet colours without end: hue by the golden angle, lightness in three steps (OKLCH: Ottosson 2020), so that neighbours in number
/// differ.
Colour list_colour(std::size_t k);

/// The first `count` of these colours, one a fragment, dealt out so that fragments which join are unlike: the fragments with most joins
/// first, each takes of the colours that are left the one farthest from those of its neighbours.
/// \param joins  pairs of numbers below `count`
std::vector<Colour> fragment_colours(std::size_t count,
                                     const std::vector<std::pair<std::size_t, std::size_t>>& joins);

}  // namespace rejoin::report
