#include "match/relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "match/strip.hpp"

namespace rejoin::match {
namespace {

constexpr double kBend = 0.8;   // share that is taken off: a bend tells less than it is large
constexpr double kLine = 1e-6;  // of the squared moments: with a smaller determinant an overlap is a line

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

/// Calls visit(k, u, v) for every pixel that counts.
template <typename Visit>
void for_pixels(const ReliefMap& map, const Visit& visit) {
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const std::size_t k =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(i);
      if (map.mask[k] != 0.0F) visit(k, static_cast<double>(i), static_cast<double>(j));
    }
  }
}

/// Takes most of the slopes of the best quadric off: s + (p x + q y, q x + r y), x and y from the middle, s the mean slope.
void take_off_bend(ReliefMap& map) {
  if (map.pixels == 0) return;
  glm::dvec2 middle(0.0);
  glm::dvec2 mean(0.0);
  for_pixels(map, [&](std::size_t k, double i, double j) {
    middle += glm::dvec2(i, j);
    mean += glm::dvec2(map.slope_u[k], map.slope_v[k]);
  });
  middle /= map.pixels;
  mean /= map.pixels;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  glm::dvec3 moments(0.0);
  for_pixels(map, [&](std::size_t k, double i, double j) {
    const glm::dvec2 at = glm::dvec2(i, j) - middle;
    const glm::dvec2 slope = glm::dvec2(map.slope_u[k], map.slope_v[k]) - mean;
    xx += at.x * at.x;
    xy += at.x * at.y;
    yy += at.y * at.y;
    moments += glm::dvec3(slope.x * at.x, slope.x * at.y + slope.y * at.x, slope.y * at.y);
  });
  const double held = 1e-6 * (xx + yy) + 1e-9;  // so that a line of pixels has an answer, too
  const glm::dmat3 normal(xx + held, xy, 0.0, xy, xx + yy + held, xy, 0.0, xy, yy + held);
  const glm::dvec3 bend = glm::inverse(normal) * moments;
  for_pixels(map, [&](std::size_t k, double i, double j) {
    const glm::dvec2 at = glm::dvec2(i, j) - middle;
    map.slope_u[k] -= static_cast<float>(kBend * (mean.x + bend.x * at.x + bend.y * at.y));
    map.slope_v[k] -= static_cast<float>(kBend * (mean.y + bend.y * at.x + bend.z * at.y));
  });
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
  take_off_bend(map);
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
  measure_across(patch);
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

PlaneBetween plane_between(const ReliefMap& fixed, const ReliefMap& facing, int shift_u, int shift_v) {
  double count = 0.0;
  glm::dvec2 sum(0.0);
  double heights = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  glm::dvec2 moments(0.0);
  for (int j = std::max(0, shift_v); j < std::min(fixed.height, facing.height + shift_v); ++j) {
    for (int i = std::max(0, shift_u); i < std::min(fixed.width, facing.width + shift_u); ++i) {
      const auto p =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(fixed.width) + static_cast<std::size_t>(i);
      const auto q = static_cast<std::size_t>(j - shift_v) * static_cast<std::size_t>(facing.width) +
                     static_cast<std::size_t>(i - shift_u);
      if (fixed.mask[p] * facing.mask[q] == 0.0F) continue;
      const glm::dvec2 at(i, j);
      const auto height = static_cast<double>(fixed.height_map[p] + facing.height_map[q]);
      count += 1.0;
      sum += at;
      heights += height;
      xx += at.x * at.x;
      xy += at.x * at.y;
      yy += at.y * at.y;
      moments += height * at;
    }
  }
  PlaneBetween plane;
  if (count == 0.0) return plane;
  const glm::dvec2 mean = sum / count;
  plane.middle = fixed.low + fixed.pitch * (mean + 0.5);
  plane.offset = heights / count;
  xx -= sum.x * mean.x;
  xy -= sum.x * mean.y;
  yy -= sum.y * mean.y;
  moments -= heights * mean;
  const double determinant = xx * yy - xy * xy;
  if (determinant <= kLine * (xx + yy) * (xx + yy)) return plane;
  plane.tilt = glm::dvec2(moments.x * yy - moments.y * xy, moments.y * xx - moments.x * xy) /
               (determinant * fixed.pitch);
  return plane;
}

}  // namespace rejoin::match
