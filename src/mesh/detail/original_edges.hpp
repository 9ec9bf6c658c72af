/// Lips, feet and other edges of a vessel that were never broken.
#pragma once

#include "mesh/facets.hpp"

namespace rejoin::mesh::detail {

/// Of a sherd, takes facets for original surface that turn away from the walls as breaks do, but are much smoother than its other breaks
/// and slide in themselves by a motion by which the walls do, too: a turn about the axis of a wheel-made vessel, a shift along a
/// moulding.  Their samples stay what they are.  \source Pottmann and Randrup 1998 (the helical motion of a surface from its points and normals)
/// \param cut  of the segmentation; its order changes
void tell_original_edges(const Segmentation& segmentation, Cut& cut);

}  // namespace rejoin::mesh::detail
