/// The facets of a segmentation from the samples that each holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/facets.hpp"

namespace rejoin::mesh::detail {

/// Fewest samples of a facet.
std::size_t smallest_facet(const Segmentation& segmentation);

/// Measures the facets and numbers them: fracture first, largest first in each class.
/// \param members  samples of each facet, none empty; a facet's class is that of its first
Cut cut_into(const Segmentation& segmentation, std::vector<std::vector<std::uint32_t>> members);

}  // namespace rejoin::mesh::detail
