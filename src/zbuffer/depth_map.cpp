#include "zbuffer/depth_map.hpp"

#include <algorithm>
#include <optional>

#include "zbuffer/detail/fixed_triangle.hpp"

namespace rejoin::zbuffer {
namespace {

/// Calls visit for every triangle that can cover a pixel.
template <class Visit>
void for_each_snapped(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, Visit visit) {
  for (const glm::uvec3& face : faces) {
    if (const auto triangle = detail::snap(points[face.x], points[face.y], points[face.z])) visit(*triangle);
  }
}

/// The depth at one pixel centre if the triangle covers it.
std::optional<float> depth_at(const detail::FixedTriangle& triangle, std::int64_t px, std::int64_t py) {
  double depth = 0;
  for (int k = 0; k < 3; ++k) {
    const detail::Edge edge = triangle.edge(k);
    const std::int64_t value = edge.at(px, py);
    if (value < edge.least()) return std::nullopt;
    depth += static_cast<double>(triangle.z[k]) * static_cast<double>(value);
  }
  return static_cast<float>(depth / static_cast<double>(triangle.area2));
}

}  // namespace

void draw(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, DepthMap& map) {
  const detail::Canvas canvas{map.depth.data(), map.width, map.height};
  for_each_snapped(points, faces, [&](const detail::FixedTriangle& t) { detail::fill(t, canvas); });
}

void draw_reference(std::span<const glm::vec3> points, std::span<const glm::uvec3> faces, DepthMap& map) {
  for_each_snapped(points, faces, [&](const detail::FixedTriangle& t) {
    for (int j = 0; j < map.height; ++j) {
      for (int i = 0; i < map.width; ++i) {
        const auto depth = depth_at(t, detail::centre_of(i), detail::centre_of(j));
        if (depth && !(map.at(i, j) < *depth)) map.at(i, j) = *depth;
      }
    }
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
