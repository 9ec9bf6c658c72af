/// Where two silhouettes cover each other best.
#pragma once

#include <glm/glm.hpp>

#include "zbuffer/depth_map.hpp"

namespace rejoin::match {

/// Peak of the cross-correlation of two silhouettes.
struct SilhouettePeak {
  glm::dvec2 shift_px{
      0.0};               ///< of A, along (u, v), that covers most; the middle of all shifts that are as good
  double overlap_px = 0;  ///< pixels that both cover there
};

/// Cross-correlates the covered pixels of A's map with those of B's map seen from A.
/// \param a, b  maps as rendered (b not mirrored), same shape
/// \return shift 0 and overlap 0 if one map is empty
/// \throws InputError if the shapes differ
/// \source papaioannou 2002, section 5.2.2, step b; deviation: none.
SilhouettePeak best_silhouette_shift(const zbuffer::DepthMap& a, const zbuffer::DepthMap& b);

}  // namespace rejoin::match
