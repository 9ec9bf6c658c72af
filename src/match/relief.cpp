#include "match/relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "zbuffer/depth_map.hpp"

namespace rejoin::match {
namespace {

/// Draws points (x, y in plane coordinates, z = height, highest wins).
ReliefMap draw_relief(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& faces,
                      double pitch) {
  glm::vec2 low(std::numeric_limits<float>::max());
  glm::vec2 high(std::numeric_limits<float>::lowest());
  for (const auto& p : points) {
    low = glm::min(low, glm::vec2(p));
    high = glm::max(high, glm::vec2(p));
  }
  ReliefMap map;
  map.pitch = pitch;
  map.low = glm::dvec2(low);
  map.width = static_cast<int>(std::ceil(static_cast<double>(high.x - low.x) / pitch)) + 1;
  map.height = static_cast<int>(std::ceil(static_cast<double>(high.y - low.y) / pitch)) + 1;
  std::vector<glm::vec3> pixels(points.size());
  const auto scale = static_cast<float>(1.0 / pitch);
  for (std::size_t i = 0; i < points.size(); ++i) {
    pixels[i] = glm::vec3((points[i].x - low.x) * scale, (points[i].y - low.y) * scale, -points[i].z);
  }
  zbuffer::DepthMap depth(map.width, map.height);
  zbuffer::draw(pixels, faces, depth);
  map.height_map = std::move(depth.depth);
  for (float& h : map.height_map) h = -h;
  return map;
}

void take_slopes(ReliefMap& map, float sign) {
  const std::size_t count = map.height_map.size();
  map.slope_u.assign(count, 0.0F);
  map.slope_v.assign(count, 0.0F);
  map.mask.assign(count, 0.0F);
  const auto w = static_cast<std::size_t>(map.width);
  const auto per_pitch = static_cast<float>(sign / map.pitch);
  for (int j = 0; j + 1 < map.height; ++j) {
    for (int i = 0; i + 1 < map.width; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * w + static_cast<std::size_t>(i);
      const float u = (map.height_map[k + 1] - map.height_map[k]) * per_pitch;
      const float v = (map.height_map[k + w] - map.height_map[k]) * per_pitch;
      if (!(std::abs(u) < kSteepest && std::abs(v) < kSteepest)) continue;
      map.slope_u[k] = u;
      map.slope_v[k] = v;
      map.mask[k] = 1.0F;
      ++map.pixels;
    }
  }
}

}  // namespace

FacetPatch cut_patch(const mesh::Mesh& mesh, const std::vector<int>& facet_of_face,
                     const mesh::Segmentation& segmentation, int facet) {
  const mesh::Facet& source = segmentation.facets[static_cast<std::size_t>(facet)];
  FacetPatch patch;
  patch.frame = glm::dmat3(source.along, glm::cross(source.normal, source.along), source.normal);
  patch.centre = source.centre;
  patch.area = source.area;
  patch.length = source.length;
  patch.width = source.width;
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t f = 0; f < facet_of_face.size(); ++f) {
    if (facet_of_face[f] == facet) chosen.push_back(f);
  }
  const mesh::Mesh part = mesh::submesh(mesh, chosen);
  patch.faces = part.faces;
  patch.points.reserve(part.vertices.size());
  for (const auto& v : part.vertices) patch.points.emplace_back((glm::dvec3(v) - patch.centre) * patch.frame);
  return patch;
}

ReliefMap relief_of(const FacetPatch& patch, double pitch) {
  ReliefMap map = draw_relief(patch.points, patch.faces, pitch);
  take_slopes(map, 1.0F);
  return map;
}

ReliefMap facing_relief_of(const FacetPatch& patch, double pitch, double turn_rad) {
  const auto c = static_cast<float>(std::cos(turn_rad));
  const auto s = static_cast<float>(std::sin(turn_rad));
  std::vector<glm::vec3> turned(patch.points.size());
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const glm::vec3 p = patch.points[i];
    turned[i] = glm::vec3(-c * p.x - s * p.y, -s * p.x + c * p.y, p.z);
  }
  ReliefMap map = draw_relief(turned, patch.faces, pitch);
  take_slopes(map, -1.0F);
  return map;
}

}  // namespace rejoin::match
