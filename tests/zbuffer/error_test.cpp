#include "zbuffer/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "core/random.hpp"

namespace rejoin::zbuffer {
namespace {

DepthMap filled(int width, int height, const std::function<float(int, int)>& depth) {
  DepthMap map(width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) map.at(i, j) = depth(i, j);
  }
  return map;
}

/// The algorithm at the end of section 3.4 as written: mirror, differences, mask, mean.
double by_definition(const DepthMap& a, const DepthMap& b, double view_side) {
  const DepthMap d2 = mirrored(b);
  double sum = 0;
  int count = 0;
  for (int j = 0; j + 1 < a.height; ++j) {
    for (int i = 0; i + 1 < a.width; ++i) {
      const double u = double(a.at(i + 1, j)) - a.at(i, j) + d2.at(i + 1, j) - d2.at(i, j);
      const double v = double(a.at(i, j + 1)) - a.at(i, j) + d2.at(i, j + 1) - d2.at(i, j);
      if (std::isnan(u) || std::isnan(v)) continue;
      sum += std::abs(u) + std::abs(v);
      ++count;
    }
  }
  return sum / count / view_side;
}

TEST(SlopeDifference, TiltedPlanesGiveTheDifferenceOfTheirSlopes) {
  // d1 rises by 3 a pixel in u and falls by 1 in v; d2 as rendered rises by 2 and 4, so mirrored by -2 and 4.
  const DepthMap a = filled(40, 24, [](int i, int j) { return 3.0F * i - 1.0F * j; });
  const DepthMap b = filled(40, 24, [](int i, int j) { return 2.0F * i + 4.0F * j; });
  const PairScore score = slope_difference(a, b, 80.0);
  EXPECT_FLOAT_EQ(score.error, (1.0F + 3.0F) / 80.0F);
  EXPECT_EQ(score.overlap, 39 * 23);
  const DepthMap slopes = slope_difference_map(a, b, 80.0);
  EXPECT_FLOAT_EQ(slopes.at(5, 7), 4.0F * 40.0F / 80.0F);
  EXPECT_TRUE(std::isnan(slopes.at(39, 7)));
  EXPECT_TRUE(std::isnan(slopes.at(5, 23)));
}

TEST(SlopeDifference, ComplementaryMapsGiveZero) {
  const auto relief = [](int i, int j) {
    return std::round(64.0F * std::sin(0.3F * i) * std::cos(0.2F * j));
  };
  const DepthMap a = filled(33, 33, relief);
  const DepthMap b = mirrored(filled(33, 33, [&](int i, int j) { return 100.0F - relief(i, j); }));
  EXPECT_EQ(slope_difference(a, b, 33.0).error, 0.0F);
}

TEST(SlopeDifference, FollowsTheDefinitionOnMapsWithHoles) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const auto depth = [&](int, int) {
      return random.uniform() < 0.2 ? kBackground : static_cast<float>(random.uniform(5, 9));
    };
    const DepthMap a = filled(61, 43, depth);
    const DepthMap b = filled(61, 43, depth);
    EXPECT_NEAR(slope_difference(a, b, 61.0).error, by_definition(a, b, 61.0),
                1e-7);  // float sums of values below 8
  }
}

TEST(SlopeDifference, CountsPixelsWithBothForwardNeighbours) {
  // a covers a 5 x 4 block: 4 x 3 of its pixels have both neighbours.  b covers everything.
  const DepthMap a =
      filled(32, 32, [](int i, int j) { return i >= 10 && i < 15 && j >= 6 && j < 10 ? 1.0F : kBackground; });
  const DepthMap b = filled(32, 32, [](int, int) { return 1.0F; });
  const PairScore score = slope_difference(a, b, 1.0);
  EXPECT_EQ(score.covered_a, 12);
  EXPECT_EQ(score.covered_b, 31 * 31);
  EXPECT_EQ(score.overlap, 12);
  EXPECT_DOUBLE_EQ(overlap_bias(score), 1.0);
}

TEST(SlopeDifference, OverlapIsCountedAfterTheMirror) {
  // Blocks that lie over each other only once b is turned round: a in columns 2 .. 9, b in 22 .. 29 of 32.
  const DepthMap a = filled(32, 32, [](int i, int) { return i >= 2 && i < 10 ? 1.0F : kBackground; });
  const DepthMap b = filled(32, 32, [](int i, int) { return i >= 22 && i < 30 ? 1.0F : kBackground; });
  EXPECT_EQ(slope_difference(a, b, 1.0).overlap, 7 * 31);
  EXPECT_EQ(slope_difference(a, a, 1.0).overlap, 0);
}

TEST(SlopeDifference, NoOverlapIsInfinite) {
  const DepthMap none(16, 16);
  const DepthMap full = filled(16, 16, [](int, int) { return 1.0F; });
  const PairScore score = slope_difference(none, full, 1.0);
  EXPECT_EQ(score.error, std::numeric_limits<float>::infinity());
  EXPECT_EQ(score.overlap, 0);
  EXPECT_EQ(score.covered_a, 0);
  EXPECT_EQ(score.covered_b, 15 * 15);
  EXPECT_EQ(overlap_bias(score), std::numeric_limits<double>::infinity());
}

TEST(SlopeDifference, DoesNotChangeWithTheUnit) {
  Random random(9);
  DepthMap a = filled(20, 20, [&](int, int) { return static_cast<float>(random.uniform(0, 4)); });
  DepthMap b = filled(20, 20, [&](int, int) { return static_cast<float>(random.uniform(0, 4)); });
  const float before = slope_difference(a, b, 10.0).error;
  for (float& d : a.depth) d *= 1024.0F;
  for (float& d : b.depth) d *= 1024.0F;
  EXPECT_EQ(slope_difference(a, b, 10240.0).error, before);
}

TEST(SlopeDifference, ShapeMismatchThrows) {
  EXPECT_THROW(slope_difference(DepthMap(8, 9), DepthMap(9, 8), 1.0), InputError);
  EXPECT_THROW(slope_difference_map(DepthMap(8, 8), DepthMap(9, 8), 1.0), InputError);
}

}  // namespace
}  // namespace rejoin::zbuffer
