#include "match/correlate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace rejoin::match {
namespace {

/// A map with random slopes and a ragged mask.
ReliefMap random_map(Random& random, int width, int height) {
  ReliefMap map;
  map.width = width;
  map.height = height;
  map.pitch = 1.0;
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  map.height_map.assign(count, 0.0F);
  map.slope_u.assign(count, 0.0F);
  map.slope_v.assign(count, 0.0F);
  map.mask.assign(count, 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    if (random.uniform() < 0.2) continue;
    map.mask[i] = 1.0F;
    map.slope_u[i] = static_cast<float>(0.4 * random.normal());
    map.slope_v[i] = static_cast<float>(0.4 * random.normal());
    ++map.pixels;
  }
  return map;
}

TEST(Correlate, EveryPeakEqualsDirectSummation) {
  Random random(11);
  CorrelateOptions options;
  options.most_peaks = 40;
  const ReliefMap a = random_map(random, 23, 17);
  const ReliefMap b = random_map(random, 14, 19);
  Correlator correlator(a, 20, 20, options);
  const auto peaks = correlator.peaks(b);
  ASSERT_FALSE(peaks.empty());
  for (const auto& peak : peaks) {
    const Agreement direct = agreement_at(a, b, peak.shift_u, peak.shift_v, options);
    EXPECT_NEAR(peak.pixels, direct.pixels, 1e-2);  // single-precision transforms of sums of some hundreds
    EXPECT_NEAR(peak.explained, direct.explained, 1e-3);
    EXPECT_NEAR(peak.score, direct.score, 2e-2);
    EXPECT_NEAR(peak.tilt.x, direct.tilt.x, 1e-3);
    EXPECT_NEAR(peak.tilt.y, direct.tilt.y, 1e-3);
  }
}

TEST(Correlate, BestPeakIsTheBestShiftOfBruteForce) {
  Random random(12);
  const CorrelateOptions options;
  const ReliefMap a = random_map(random, 20, 16);
  const ReliefMap b = random_map(random, 15, 12);
  const float least = std::max(options.least_pixels,
                               options.least_overlap * static_cast<float>(std::min(a.pixels, b.pixels)));
  Agreement best;
  for (int v = -b.height + 1; v < a.height; ++v) {
    for (int u = -b.width + 1; u < a.width; ++u) {
      const Agreement now = agreement_at(a, b, u, v, options);
      if (now.pixels >= least && now.score > best.score) best = now;
    }
  }
  Correlator correlator(a, b.width, b.height, options);
  const auto peaks = correlator.peaks(b);
  ASSERT_FALSE(peaks.empty());
  EXPECT_EQ(peaks.front().shift_u, best.shift_u);
  EXPECT_EQ(peaks.front().shift_v, best.shift_v);
}

TEST(Correlate, CutOutPieceIsFoundWhereItWasCutWhateverItsTilt) {
  Random random(13);
  const ReliefMap a = random_map(random, 40, 30);
  ReliefMap b = random_map(random, 12, 10);
  for (int j = 0; j < b.height; ++j) {
    for (int i = 0; i < b.width; ++i) {
      const auto from = static_cast<std::size_t>((j + 8) * a.width + i + 17);
      const auto to = static_cast<std::size_t>(j * b.width + i);
      b.mask[to] = a.mask[from];
      b.slope_u[to] = a.mask[from] * (a.slope_u[from] + 0.3F);
      b.slope_v[to] = a.mask[from] * (a.slope_v[from] - 0.2F);
    }
  }
  Correlator correlator(a, b.width, b.height, CorrelateOptions{});
  const auto peaks = correlator.peaks(b);
  ASSERT_FALSE(peaks.empty());
  EXPECT_EQ(peaks.front().shift_u, 17);
  EXPECT_EQ(peaks.front().shift_v, 8);
  EXPECT_NEAR(peaks.front().tilt.x, -0.3, 1e-3);
  EXPECT_NEAR(peaks.front().tilt.y, 0.2, 1e-3);
  EXPECT_GT(peaks.front().explained, 0.95);  // all but the noise term of the denominator
}

TEST(Correlate, FlatOnFlatExplainsNothing) {
  Random random(14);
  ReliefMap a = random_map(random, 30, 30);
  ReliefMap b = random_map(random, 30, 30);
  for (auto* map : {&a, &b}) {
    for (float& slope : map->slope_u) slope *= 0.01F;
    for (float& slope : map->slope_v) slope *= 0.01F;
  }
  Correlator correlator(a, b.width, b.height, CorrelateOptions{});
  for (const auto& peak : correlator.peaks(b)) EXPECT_LT(peak.explained, 0.05);
}

}  // namespace
}  // namespace rejoin::match
