/// From a pose to pixels: the one mapping that every backend draws with.
#pragma once

#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer::detail {

/// Affine map from a fragment's vertices (relative to its mesh's origin) to
/// (x, y in pixel coordinates, depth in mesh units): pixel (i, j) has its centre at (i + 0.5, j + 0.5).
struct Projection {
  glm::mat3 linear{1.0F};  ///< columns, as everywhere in GLM
  glm::vec3 offset{0.0F};

  /// The order of the operations is part of the contract: backends that repeat it get the same bits.
  glm::vec3 operator()(const glm::vec3& v) const { return {row(0, v), row(1, v), row(2, v)}; }

  bool operator==(const Projection&) const = default;

 private:
  float row(int r, const glm::vec3& v) const {
    return ((linear[0][r] * v.x + linear[1][r] * v.y) + linear[2][r] * v.z) + offset[r];
  }
};

/// How a projection looks at the fragment.
struct Gaze {
  glm::vec3 along{
      0.0F};  ///< unit direction of growing depth, in the fragment's axes; 0: it looks at nothing, or not clearly
  bool mirrored = false;
};
Gaze gaze_of(const Projection& projection);

/// The options checked and with view_side filled in: 1.3 x the larger diameter where it was not given.
/// Nothing is clipped in depth: a surface in front of (p) gets a negative depth.
/// \throws InputError  a mesh without faces, a resolution outside 8 .. 2048, a view side or centre that is
/// not finite \source papaioannou 2002, section 3.4, initialization
ViewOptions completed(const mesh::Mesh& a, const mesh::Mesh& b, ViewOptions options);

/// \param options  completed
Projection projection_a(const ViewPair& pose, const ViewOptions& options);
Projection projection_b(const ViewPair& pose, const ViewOptions& options);

}  // namespace rejoin::zbuffer::detail
