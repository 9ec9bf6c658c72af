#include "zbuffer/triangles.hpp"

#include <cmath>
#include <limits>

#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer {

struct Triangles::Soup {
  detail::TriangleSoup triangles;
};

Triangles::Triangles(const mesh::Mesh& mesh)
    : soup_(std::make_shared<const Soup>(Soup{detail::soup_of(mesh)})) {}

void Triangles::draw(const glm::mat3& linear, const glm::vec3& offset, DepthMap& map) const {
  if (!soup_) return;
  constexpr float kNothing = std::numeric_limits<float>::infinity();  // against which every depth wins
  for (float& depth : map.depth) depth = std::isnan(depth) ? kNothing : depth;
  detail::draw_soup(soup_->triangles, {linear, offset}, {map.depth.data(), map.width, map.height});
  for (float& depth : map.depth) depth = depth == kNothing ? kBackground : depth;
}

}  // namespace rejoin::zbuffer
