#include "match/relief.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "match/correlate.hpp"

namespace rejoin::match {
namespace {

constexpr double kPi = 3.14159265358979323846;

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
  for (const double turn : {0.5 * kPi, kPi, 1.5 * kPi}) {
    for (const Agreement& other : correlator.peaks(facing_relief_of(b, 0.5, turn))) {
      EXPECT_LT(other.score, 0.8F * best.score) << turn;
    }
  }
}

}  // namespace
}  // namespace rejoin::match
