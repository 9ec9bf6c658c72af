/// Triangles on a sub-pixel grid, where coverage is decided in exact integers.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "zbuffer/detail/canvas.hpp"

namespace rejoin::zbuffer::detail {

/// Steps of the grid a pixel; a corner moves by at most 1/2048 pixel, a depth by that times the slope.
inline constexpr int kSubpixels = 1024;
/// Corners farther from the map's origin than this many pixels are not drawn: edge functions stay within 62
/// bits.
inline constexpr float kReach = 524288.0F;

/// E(x, y) = dx * y' - dy * x' in squared grid steps, positive on the inner side.
///
/// A pixel centre with E = 0 is covered only where the edge runs downwards in y, or level towards smaller x:
/// of two triangles that share the edge exactly one has it so.  Adding 1 - least to E turns the test into a
/// sign.
struct Edge {
  std::int64_t x, y;    ///< first corner
  std::int64_t dx, dy;  ///< to the second corner

  std::int64_t at(std::int64_t px, std::int64_t py) const { return dx * (py - y) - dy * (px - x); }
  std::int64_t least() const { return (dy < 0 || (dy == 0 && dx < 0)) ? 0 : 1; }
};

/// Counter-clockwise (positive area) triangle on the grid with the depths of its corners.
struct FixedTriangle {
  std::int64_t x[3];
  std::int64_t y[3];
  float z[3];
  std::int64_t area2;  ///< twice the area, squared grid steps, > 0

  /// The edge opposite corner k; its value over area2 is that corner's weight.
  Edge edge(int k) const {
    const int from = (k + 1) % 3;
    const int to = (k + 2) % 3;
    return {x[from], y[from], x[to] - x[from], y[to] - y[from]};
  }
};

/// Grid coordinate of the centre of pixel i.
constexpr std::int64_t centre_of(std::int64_t i) {
  return i * kSubpixels + kSubpixels / 2;
}

/// Snaps to the grid; nullopt for a triangle that covers nothing: no area, a corner that is not finite or out
/// of reach.
std::optional<FixedTriangle> snap(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Makes a triangle whose x, y and z are set counter-clockwise and sets its area; false if it has none.
bool orient(FixedTriangle& triangle);

/// Draws one triangle, row by row, nearest depth wins.
void fill(const FixedTriangle& triangle, const Canvas& canvas);

}  // namespace rejoin::zbuffer::detail
