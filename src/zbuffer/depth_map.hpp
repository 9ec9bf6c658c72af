/// Depth maps of one fragment.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

namespace rejoin::zbuffer {

inline constexpr float kBackground = std::numeric_limits<float>::quiet_NaN();

/// Distances from the reference plane (p), seen orthographically.
///
/// Pixel (i, j) has its centre at (i + 0.5, j + 0.5) in pixel coordinates; i grows with x (the paper's u), j
/// with y (v).
struct DepthMap {
  int width = 0;
  int height = 0;
  std::vector<float> depth;  ///< row after row, mesh units, kBackground where nothing was seen

  DepthMap() = default;
  DepthMap(int w, int h) : width(w), height(h), depth(static_cast<std::size_t>(w) * h, kBackground) {}

  float at(int i, int j) const { return depth[static_cast<std::size_t>(j) * width + i]; }
  float& at(int i, int j) { return depth[static_cast<std::size_t>(j) * width + i]; }
};

/// Draws triangles into `map`, nearest depth wins; pixels whose centre a triangle covers (top-left rule, so
/// that a pixel on a shared edge belongs to exactly one of the two) get its depth at the centre.  Existing
/// content takes part in the depth test. Both windings are drawn: a scan's faces are not always oriented.
/// \param points  x, y in pixel coordinates of the map, z = distance from (p), smaller is nearer
/// \param faces   indices into points; those with a corner that is not finite, or more than 524288 pixels
/// from
///                the map's origin in x or y, are skipped
void draw(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, DepthMap& map);

/// The same by testing every pixel against every triangle, depths in double precision: the reference for
/// tests. Both decide coverage on one grid of 1/1024 pixel in exact integers, so they cover exactly the same
/// pixels.
void draw_reference(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, DepthMap& map);

/// The map with its u axis turned round: d2(i, j) = Z2(Nu - 1 - i, j).  \source papaioannou 2002, eq. (10b)
DepthMap mirrored(const DepthMap& map);

}  // namespace rejoin::zbuffer
