#include "match/relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "match/correlate.hpp"

namespace rejoin::match {
namespace {

/// Rectangles of a plane, z = 0, mm.
FacetPatch flat_patch(const std::vector<glm::vec4>& rectangles) {
  mesh::Mesh mesh;
  for (const auto& r : rectangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec2 corner :
         {glm::vec2(r.x, r.y), glm::vec2(r.z, r.y), glm::vec2(r.z, r.w), glm::vec2(r.x, r.w)})
      mesh.vertices.emplace_back(corner, 0.0F);
    mesh.faces.emplace_back(first, first + 1, first + 2);
    mesh.faces.emplace_back(first, first + 2, first + 3);
  }
  FacetPatch patch;
  patch.triangles = zbuffer::Triangles(mesh);
  patch.points = mesh.vertices;
  return patch;
}

/// z over a grid of 60 x 40 mm in steps of 1 mm.
template <typename Height>
FacetPatch patch_of(const Height& z) {
  constexpr std::uint32_t kU = 60;
  constexpr std::uint32_t kV = 40;
  mesh::Mesh mesh;
  for (std::uint32_t j = 0; j <= kV; ++j) {
    for (std::uint32_t i = 0; i <= kU; ++i) {
      const glm::dvec2 at(static_cast<double>(i) - 25, static_cast<double>(j) - 18);
      mesh.vertices.emplace_back(glm::dvec3(at, z(at)));
      if (i == kU || j == kV) continue;
      const std::uint32_t v = j * (kU + 1) + i;
      mesh.faces.emplace_back(v, v + 1, v + kU + 2);
      mesh.faces.emplace_back(v, v + kU + 2, v + kU + 1);
    }
  }
  FacetPatch patch;
  patch.triangles = zbuffer::Triangles(mesh);
  patch.points = mesh.vertices;
  return patch;
}

/// Mean square of the slopes.
double energy(const ReliefMap& map) {
  double sum = 0;
  for (std::size_t k = 0; k < map.mask.size(); ++k)
    sum += static_cast<double>(map.slope_u[k] * map.slope_u[k] + map.slope_v[k] * map.slope_v[k]);
  return sum / map.pixels;
}

TEST(Relief, OfABendAFifthIsLeftAndOfWhatIsFinerAll) {
  const auto bend = [](const glm::dvec2& p) {
    return 0.2 * p.x - 0.1 * p.y + 0.008 * p.x * p.x - 0.004 * p.x * p.y - 0.006 * p.y * p.y;
  };
  const auto fine = [](const glm::dvec2& p) { return 0.8 * std::sin(0.9 * p.x) * std::cos(0.7 * p.y); };
  const auto sum = [&](const glm::dvec2& p) { return bend(p) + fine(p); };
  const ReliefMap bent = relief_of(patch_of(bend), 2.0);
  double steepest = 0;
  double off = 0;
  for (int j = 0; j + 1 < bent.height; ++j) {
    for (int i = 0; i + 1 < bent.width; ++i) {
      const auto k = static_cast<std::size_t>(j * bent.width + i);
      if (bent.mask[k] == 0.0F) continue;
      const double slope = static_cast<double>(bent.height_map[k + 1] - bent.height_map[k]) / bent.pitch;
      steepest = std::max(steepest, std::abs(slope));
      off = std::max(off, std::abs(static_cast<double>(bent.slope_u[k]) - 0.2 * slope));
    }
  }
  EXPECT_GT(steepest, 0.5);
  EXPECT_LT(off, 0.02);
  const double both = energy(relief_of(patch_of(sum), 2.0));
  const double alone = energy(relief_of(patch_of(fine), 2.0));
  EXPECT_NEAR(both, alone + energy(bent), 0.1 * alone);
  EXPECT_NEAR(energy(facing_relief_of(patch_of(sum), 2.0, 0.0)), both, 0.1 * both);
}

TEST(Relief, ThePlaneBetweenTwoIsThatOfTheirSpace) {
  // Heights that add up to a plane, whatever each of them is, over the part that both cover.
  ReliefMap a;
  a.width = 12;
  a.height = 9;
  a.pitch = 0.5;
  a.low = {3.0, -2.0};
  ReliefMap b = a;
  b.width = 10;
  b.height = 8;
  constexpr int kShiftU = 4;
  constexpr int kShiftV = -3;
  const auto place = [&](int i, int j) { return a.low + a.pitch * (glm::dvec2(i, j) + 0.5); };
  for (auto* map : {&a, &b}) {
    map->mask.assign(static_cast<std::size_t>(map->width * map->height), 1.0F);
    for (int j = 0; j < map->height; ++j) {
      for (int i = 0; i < map->width; ++i) {
        const glm::dvec2 at = map == &a ? place(i, j) : place(i + kShiftU, j + kShiftV);
        const double wave = std::sin(at.x) * std::cos(2.0 * at.y);
        map->height_map.push_back(
            static_cast<float>(map == &a ? wave : 0.7 + 0.3 * at.x - 0.2 * at.y - wave));
      }
    }
  }
  a.mask[5] = 0.0F;
  const PlaneBetween plane = plane_between(a, b, kShiftU, kShiftV);
  EXPECT_NEAR(plane.tilt.x, 0.3, 1e-5);
  EXPECT_NEAR(plane.tilt.y, -0.2, 1e-5);
  EXPECT_NEAR(plane.offset, 0.7 + 0.3 * plane.middle.x - 0.2 * plane.middle.y, 1e-5);
  EXPECT_GT(plane.middle.x, place(kShiftU, 0).x);
  EXPECT_LT(plane.middle.y, place(0, b.height + kShiftV).y);
  // One line of pixels tells no tilt across it; none, nothing.
  EXPECT_EQ(plane_between(a, b, a.width - 1, 0).tilt, glm::dvec2(0.0));
  EXPECT_EQ(plane_between(a, b, a.width, 0).offset, 0.0);
}

TEST(Relief, PixelsAndTheirBordersAreCounted) {
  ReliefMap map;
  map.width = 4;
  map.height = 3;
  map.mask = {0, 1, 0, 1,  //
              1, 1, 0, 0,  //
              0, 0, 0, 0};
  count_pixels(map);
  EXPECT_EQ(map.pixels, 4);
  EXPECT_EQ(map.columns, (std::vector<int>{1, 2, 0, 1}));
  EXPECT_EQ(map.rows, (std::vector<int>{2, 2, 0}));
  EXPECT_EQ(map.border, 8 + 4);
}

TEST(Relief, FlatBreaksAreLaidOnOneAnotherByTheirOutlines) {
  // An L, and its mirror image as its partner sees it, elsewhere in its own plane and without the end of one arm.
  const ReliefMap a = relief_of(flat_patch({{0, 0, 12, 40}, {12, 0, 30, 14}}), 0.5);
  const FacetPatch b = flat_patch({{-3, 5, -15, 36}, {-15, 5, -33, 19}});
  ASSERT_EQ(a.slope_u, std::vector<float>(a.slope_u.size(), 0.0F));
  Correlator correlator(a, CorrelateOptions{});
  const ReliefMap facing = facing_relief_of(b, 0.5, 0.0);
  const auto peaks = correlator.peaks(facing);
  ASSERT_FALSE(peaks.empty());
  const Agreement best = peaks.front();
  EXPECT_NEAR(best.explained, 0.0F, 1e-5F);
  EXPECT_GT(best.along, 0.8F);
  EXPECT_LE(best.along, 1.0F);  // corners are rounded off, and nothing lies beside the border twice
  // Pixel (0, 0) of both maps is the corner of the L.
  EXPECT_EQ(best.shift_u, 0);
  EXPECT_EQ(best.shift_v, 0);
  for (const double turn : {0.5 * std::numbers::pi, std::numbers::pi, 1.5 * std::numbers::pi}) {
    for (const Agreement& other : correlator.peaks(facing_relief_of(b, 0.5, turn))) {
      EXPECT_LT(other.score, 0.8F * best.score) << turn;
    }
  }
}

}  // namespace
}  // namespace rejoin::match
