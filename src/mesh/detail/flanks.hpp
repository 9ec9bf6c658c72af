/// Slopes of what stands out of a wall or is cut into it.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/detail/mean_normals.hpp"
#include "mesh/facets.hpp"

namespace rejoin::mesh::detail {

/// Makes those fracture facets of a sherd original that are the flanks of throwing ridges, grooves or ornament: about as thick as the wall, and
/// around them lies one skin that looks about the same way, or more such flanks.  A break lies between two skins, or beside another break.
/// \param facets  samples of each   \param thickness  per sample: what a ray straight inwards goes through, mesh units   \param near  per sample
void take_flanks_for_walls(Segmentation& s, const std::vector<std::vector<std::uint32_t>>& facets,
                           const std::vector<float>& thickness, const Lists& near);

}  // namespace rejoin::mesh::detail
