#include "match/silhouette.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"

namespace rejoin::match {
namespace {

// Covers [x0, x1) x [y0, y1) of an n x n map.
zbuffer::DepthMap rectangle(int n, int x0, int x1, int y0, int y1) {
  zbuffer::DepthMap map(n, n);
  for (int j = y0; j < y1; ++j) {
    for (int i = x0; i < x1; ++i) map.at(i, j) = 1;
  }
  return map;
}

int overlap_at(const zbuffer::DepthMap& a, const zbuffer::DepthMap& facing, int dx, int dy) {
  int count = 0;
  for (int j = 0; j < a.height; ++j) {
    for (int i = 0; i < a.width; ++i) {
      const int x = i + dx;
      const int y = j + dy;
      if (x < 0 || y < 0 || x >= a.width || y >= a.height) continue;
      count += !std::isnan(a.at(i, j)) && !std::isnan(facing.at(x, y)) ? 1 : 0;
    }
  }
  return count;
}

TEST(Silhouette, FindsTheShiftThatCoversARectangleAcrossTheMirror) {
  const auto a = rectangle(32, 2, 10, 20, 25);
  const auto b = rectangle(32, 3, 11, 4, 9);  // seen from A: columns 21 .. 28
  const SilhouettePeak peak = best_silhouette_shift(a, b);
  EXPECT_DOUBLE_EQ(peak.shift_px.x, 19);
  EXPECT_DOUBLE_EQ(peak.shift_px.y, -16);
  EXPECT_DOUBLE_EQ(peak.overlap_px, 40);
}

TEST(Silhouette, SmallInsideLargeGivesTheMiddle) {
  const auto a = rectangle(32, 0, 4, 0, 4);
  const auto b = rectangle(32, 10, 20, 10, 20);  // seen from A: columns 12 .. 21
  const SilhouettePeak peak = best_silhouette_shift(a, b);
  EXPECT_DOUBLE_EQ(peak.shift_px.x, 15);  // 12 .. 18 all cover it
  EXPECT_DOUBLE_EQ(peak.shift_px.y, 13);
  EXPECT_DOUBLE_EQ(peak.overlap_px, 16);
}

// Twenty pixels across, with a hole of twelve.
zbuffer::DepthMap ring(int n) {
  zbuffer::DepthMap map = rectangle(n, 6, 26, 6, 26);
  for (int j = 10; j < 22; ++j) {
    for (int i = 10; i < 22; ++i) map.at(i, j) = zbuffer::kBackground;
  }
  return map;
}

TEST(Silhouette, SmallOneIsLaidOnARingRatherThanIntoItsHole) {
  const auto a = rectangle(32, 14, 17, 14, 17);
  const auto b = ring(32);
  const SilhouettePeak peak = best_silhouette_shift(a, b);
  EXPECT_EQ(peak.overlap_px, 9);
  const auto facing = zbuffer::mirrored(b);
  EXPECT_EQ(overlap_at(a, facing, static_cast<int>(peak.shift_px.x), static_cast<int>(peak.shift_px.y)), 9);
}

TEST(Silhouette, OfARingThePlaceNearestToTheAskedOneIsTaken) {
  const auto a = rectangle(32, 14, 17, 14, 17);
  EXPECT_EQ(best_silhouette_shift(a, ring(32), glm::dvec2(20, 0)).shift_px, glm::dvec2(9, 0));
  EXPECT_EQ(best_silhouette_shift(a, ring(32), glm::dvec2(0, -20)).shift_px, glm::dvec2(0, -8));
}

TEST(Silhouette, AgreesWithEveryShiftTriedByHand) {
  Random random(3);
  for (int round = 0; round < 5; ++round) {
    zbuffer::DepthMap a(17, 17);
    zbuffer::DepthMap b(17, 17);
    for (float& d : a.depth) d = random.uniform() < 0.3 ? 1.0F : zbuffer::kBackground;
    for (float& d : b.depth) d = random.uniform() < 0.3 ? 1.0F : zbuffer::kBackground;
    const auto facing = zbuffer::mirrored(b);
    int most = 0;
    std::vector<glm::dvec2> ties;
    for (int dy = -16; dy <= 16; ++dy) {
      for (int dx = -16; dx <= 16; ++dx) {
        const int overlap = overlap_at(a, facing, dx, dy);
        if (overlap > most) ties.clear();
        most = std::max(most, overlap);
        if (overlap == most) ties.emplace_back(dx, dy);
      }
    }
    const SilhouettePeak peak = best_silhouette_shift(a, b);
    EXPECT_DOUBLE_EQ(peak.overlap_px, most);
    glm::dvec2 middle(0.0);
    for (const glm::dvec2& tie : ties) middle += tie / static_cast<double>(ties.size());
    double nearest = 1e9;
    for (const glm::dvec2& tie : ties) nearest = std::min(nearest, glm::distance(tie, middle));
    EXPECT_NEAR(glm::distance(peak.shift_px, middle), ties.size() > 1 ? nearest : 0.0, 1e-9);
  }
}

TEST(Silhouette, AnEmptyMapGivesNoShiftAndShapesMustAgree) {
  const auto a = rectangle(16, 2, 5, 2, 5);
  const SilhouettePeak peak = best_silhouette_shift(a, zbuffer::DepthMap(16, 16));
  EXPECT_EQ(peak.overlap_px, 0);
  EXPECT_EQ(peak.shift_px, glm::dvec2(0.0));
  EXPECT_THROW(best_silhouette_shift(a, zbuffer::DepthMap(16, 8)), InputError);
}

}  // namespace
}  // namespace rejoin::match
