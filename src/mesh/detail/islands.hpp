/// Small breaks amid the skin of a sherd.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/detail/grow.hpp"

namespace rejoin::mesh::detail {

/// Adds the scars that a handle or a foot leaves on a vessel: broken surface that skin surrounds, as large as a facet has to be, hardly more
/// than three times as long as wide, and so bent that it fell into groups none of which is a facet.  Each becomes one, of what looks
/// its way.
/// \param sample_area  surface that a sample stands for, squared mesh units
/// \param smallest     samples of a facet
/// \param facets       samples of each, of both classes
void add_islands(const Ground& ground, double sample_area, std::size_t smallest,
                 std::vector<std::vector<std::uint32_t>>& facets);

}  // namespace rejoin::mesh::detail
