#include "zbuffer/depth_map.hpp"

#include <algorithm>
#include <cmath>

#include "zbuffer/detail/fixed_triangle.hpp"

namespace rejoin::zbuffer {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Calls visit for every triangle that can cover a pixel.
template <class Visit>
void for_each_snapped(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, Visit visit) {
  for (const glm::uvec3& face : faces) {
    if (const auto triangle = detail::snap(points[face.x], points[face.y], points[face.z])) visit(*triangle);
  }
}

/// Lets `write` work on the map with +infinity as background, against which every depth wins.
template <class Write>
void with_infinite_background(DepthMap& map, Write write) {
  for (float& depth : map.depth) depth = std::isnan(depth) ? kNothing : depth;
  write();
  for (float& depth : map.depth) depth = depth == kNothing ? kBackground : depth;
}

/// The depth at one pixel centre if the triangle covers it, else kNothing.
float depth_at(const detail::FixedTriangle& triangle, std::int64_t px, std::int64_t py) {
  double depth = 0;
  for (int k = 0; k < 3; ++k) {
    const detail::Edge edge = triangle.edge(k);
    const std::int64_t value = edge.at(px, py);
    if (value < edge.least()) return kNothing;
    depth += static_cast<double>(triangle.z[k]) * static_cast<double>(value);
  }
  return static_cast<float>(depth / static_cast<double>(triangle.area2));
}

}  // namespace

void draw(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, DepthMap& map) {
  with_infinite_background(map, [&] {
    const detail::Canvas canvas{map.depth.data(), map.width, map.height};
    for_each_snapped(points, faces, [&](const detail::FixedTriangle& t) { detail::fill(t, canvas); });
  });
}

void draw_reference(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, DepthMap& map) {
  with_infinite_background(map, [&] {
    for_each_snapped(points, faces, [&](const detail::FixedTriangle& t) {
      for (int j = 0; j < map.height; ++j) {
        for (int i = 0; i < map.width; ++i) {
          map.at(i, j) = std::min(map.at(i, j), depth_at(t, detail::centre_of(i), detail::centre_of(j)));
        }
      }
    });
  });
}

DepthMap mirrored(const DepthMap& map) {
  DepthMap result = map;
  for (int j = 0; j < map.height; ++j) {
    const auto row = result.depth.begin() + static_cast<std::ptrdiff_t>(j) * map.width;
    std::reverse(row, row + map.width);
  }
  return result;
}

}  // namespace rejoin::zbuffer
