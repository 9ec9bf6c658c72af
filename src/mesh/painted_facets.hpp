/// Facets as a user painted them, where segmentation is wrong.
#pragma once

#include <optional>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// The segmentation with the facets of a painted surface: every colour is a fracture facet, light grey is original surface,
/// dark grey is what was found but in no facet.
/// \param segmentation  of the fragment, found by segment()
/// \param origin        of the segmented mesh
/// \param painted       the same surface with a colour for each vertex; a face has the colour of most of its corners
/// \return nullopt if less than nine tenths of the fragment lie on the painted surface
/// \pre painted has faces and colours
std::optional<Segmentation> painted_facets(const Segmentation& segmentation, const glm::dvec3& origin,
                                           const Mesh& painted);

}  // namespace rejoin::mesh
