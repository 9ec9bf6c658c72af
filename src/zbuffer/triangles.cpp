#include "zbuffer/triangles.hpp"

#include "zbuffer/detail/raster_kernel.hpp"

namespace rejoin::zbuffer {

struct Triangles::Soup {
  detail::TriangleSoup triangles;
};

Triangles::Triangles(const mesh::Mesh& mesh)
    : soup_(std::make_shared<const Soup>(Soup{detail::soup_of(mesh)})) {}

void Triangles::draw(const glm::mat3& linear, const glm::vec3& offset, DepthMap& map) const {
  if (!soup_) return;
  detail::draw_soup(soup_->triangles, {linear, offset}, {map.depth.data(), map.width, map.height});
}

}  // namespace rejoin::zbuffer
