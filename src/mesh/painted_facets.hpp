/// Facets as a user painted them, where segmentation is wrong.
#pragma once

#include <optional>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// A segmentation by a painted surface.
struct PaintedFacets {
  Segmentation segmentation;
  std::size_t left_out = 0;  ///< colours on too little of the surface to be facets
};

/// The segmentation with the facets of a painted surface: every colour is a fracture facet, light grey is original surface,
/// dark grey is what was found but in no facet.  A colour on less than half the smallest facet that segment() finds is no facet:
/// a facet that comes back as it was found has lost samples along its border.
/// \param segmentation  of the fragment, found by segment()
/// \param origin        of the segmented mesh
/// \param painted       the same surface with a colour for each vertex; a face has the colour of most of its corners
/// \return nullopt if less than nine tenths of the fragment lie on the painted surface
/// \pre painted has faces and colours
std::optional<PaintedFacets> painted_facets(const Segmentation& segmentation, const glm::dvec3& origin,
                                            const Mesh& painted);

}  // namespace rejoin::mesh
