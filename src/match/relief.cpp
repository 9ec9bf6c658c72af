#include "match/relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rejoin::match {
namespace {

/// Draws a patch as it lies after `turn` (x, y in plane coordinates, z = height, highest wins).
ReliefMap draw_relief(const FacetPatch& patch, const glm::mat2& turn, double pitch) {
  glm::vec2 low(std::numeric_limits<float>::max());
  glm::vec2 high(std::numeric_limits<float>::lowest());
  for (const auto& p : patch.points) {
    const glm::vec2 turned = turn * glm::vec2(p);
    low = glm::min(low, turned);
    high = glm::max(high, turned);
  }
  ReliefMap map;
  map.pitch = pitch;
  map.low = glm::dvec2(low);
  map.width = static_cast<int>(std::ceil(static_cast<double>(high.x - low.x) / pitch)) + 1;
  map.height = static_cast<int>(std::ceil(static_cast<double>(high.y - low.y) / pitch)) + 1;
  const auto scale = static_cast<float>(1.0 / pitch);
  const glm::mat3 linear(glm::vec3(scale * turn[0], 0.0F), glm::vec3(scale * turn[1], 0.0F),
                         glm::vec3(0.0F, 0.0F, -1.0F));
  zbuffer::DepthMap depth(map.width, map.height);
  patch.triangles.draw(linear, glm::vec3(-scale * low, 0.0F), depth);
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
    }
  }
  count_pixels(map);
}

}  // namespace

void count_pixels(ReliefMap& map) {
  const auto width = static_cast<std::size_t>(map.width);
  const std::vector<float> empty(width, 0.0F);
  map.columns.assign(width, 0);
  map.rows.clear();
  map.pixels = 0;
  map.border = 0;
  const float* above = empty.data();
  for (int j = 0; j <= map.height; ++j) {
    const float* row = j < map.height ? map.mask.data() + static_cast<std::size_t>(j) * width : empty.data();
    int in_row = 0;
    int sides = row[0] != 0.0F ? 1 : 0;
    for (std::size_t i = 0; i < width; ++i) {
      const int counts = row[i] != 0.0F ? 1 : 0;
      const float next = i + 1 < width ? row[i + 1] : 0.0F;
      in_row += counts;
      map.columns[i] += counts;
      sides += (row[i] != above[i] ? 1 : 0) + (row[i] != next ? 1 : 0);
    }
    above = row;
    map.border += sides;
    if (j == map.height) break;
    map.rows.push_back(in_row);
    map.pixels += in_row;
  }
}

FacetPatch cut_patch(const mesh::Mesh& mesh, const std::vector<int>& facet_of_face, const mesh::Cut& cut,
                     int facet) {
  const mesh::Facet& source = cut.facets[static_cast<std::size_t>(facet)];
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
  mesh::Mesh part = mesh::submesh(mesh, chosen);
  for (auto& v : part.vertices) v = glm::vec3((glm::dvec3(v) - patch.centre) * patch.frame);
  patch.triangles = zbuffer::Triangles(part);
  patch.points = std::move(part.vertices);
  return patch;
}

ReliefMap relief_of(const FacetPatch& patch, double pitch) {
  ReliefMap map = draw_relief(patch, glm::mat2(1.0F), pitch);
  take_slopes(map, 1.0F);
  return map;
}

ReliefMap facing_relief_of(const FacetPatch& patch, double pitch, double turn_rad) {
  const auto c = static_cast<float>(std::cos(turn_rad));
  const auto s = static_cast<float>(std::sin(turn_rad));
  ReliefMap map = draw_relief(patch, glm::mat2(-c, -s, -s, c), pitch);
  take_slopes(map, -1.0F);
  return map;
}

}  // namespace rejoin::match
