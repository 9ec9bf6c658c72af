/// Where two silhouettes cover each other best.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "zbuffer/depth_map.hpp"

namespace rejoin::match {

/// Peak of the cross-correlation of two silhouettes.
struct SilhouettePeak {
  /// Of A, along (u, v), that covers most: the middle of all shifts that are as good or, where it is none of them, as in the hole of a
  /// ring before a small ball, the one that lies nearest.
  glm::dvec2 shift_px{0.0};
  double overlap_px = 0;  ///< pixels that both cover there
};

/// Cross-correlates the covered pixels of A's map with those of B's map seen from A.
/// \param a, b  maps as rendered (b not mirrored), same shape
/// \param near_px  where the middle covers less, the best shift nearest to this is taken instead; default: to the middle
/// \return shift 0 and overlap 0 if one map is empty
/// \throws InputError if the shapes differ
/// \source papaioannou 2002, section 5.2.2, step b; deviation: what is taken of several shifts that cover as much, of which the
///         paper tells nothing.
SilhouettePeak best_silhouette_shift(const zbuffer::DepthMap& a, const zbuffer::DepthMap& b,
                                     const std::optional<glm::dvec2>& near_px = {});

}  // namespace rejoin::match
