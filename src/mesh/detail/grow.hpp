/// Facets by region growing over samples.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/facets.hpp"

namespace rejoin::mesh::detail {

struct GrowOptions {
  double spacing = 0;         ///< sample spacing, mesh units
  float cone_deg = 35.0F;     ///< normals of a facet stay within this angle of its mean
  float step_deg = 30.0F;     ///< neighbours across a facet differ by less than this
  std::size_t smallest = 20;  ///< smaller facets go to the neighbour they fit best
};

/// Groups of samples; no group mixes classes.  Every sample is in at most one.
std::vector<std::vector<std::uint32_t>> grow_facets(const std::vector<glm::vec3>& points,
                                                    const std::vector<glm::vec3>& normals,
                                                    const std::vector<Surface>& surface,
                                                    const std::vector<std::vector<std::uint32_t>>& near,
                                                    const GrowOptions& options);

}  // namespace rejoin::mesh::detail
