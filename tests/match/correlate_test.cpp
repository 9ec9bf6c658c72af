#include "match/correlate.hpp"

#include <gtest/gtest.h>

#include <hwy/highway.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/random.hpp"
#include "match/detail/correlate_kernel.hpp"

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
  }
  count_pixels(map);
  return map;
}

TEST(Correlate, EveryPeakEqualsDirectSummation) {
  Random random(11);
  CorrelateOptions options;
  options.most_peaks = 40;
  const ReliefMap a = random_map(random, 23, 17);
  const ReliefMap b = random_map(random, 14, 19);
  Correlator correlator(a, options);
  const auto peaks = correlator.peaks(b);
  ASSERT_FALSE(peaks.empty());
  for (const auto& peak : peaks) {
    const Agreement direct = agreement_at(a, b, peak.shift_u, peak.shift_v, options);
    EXPECT_NEAR(peak.pixels, direct.pixels, 1e-2);  // single-precision transforms of sums of some hundreds
    EXPECT_NEAR(peak.explained, direct.explained, 1e-3);
    EXPECT_NEAR(peak.along, direct.along, 1e-3);
    EXPECT_NEAR(peak.score, direct.score, 2e-2);
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
  Correlator correlator(a, options);
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
  count_pixels(b);
  Correlator correlator(a, CorrelateOptions{});
  const auto peaks = correlator.peaks(b);
  ASSERT_FALSE(peaks.empty());
  EXPECT_EQ(peaks.front().shift_u, 17);
  EXPECT_EQ(peaks.front().shift_v, 8);
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
  Correlator correlator(a, CorrelateOptions{});
  for (const auto& peak : correlator.peaks(b)) EXPECT_LT(peak.explained, 0.05);
}

/// A map whose mask is an ellipse, so that its first and last rows and columns hold little.
ReliefMap round_map(Random& random, int width, int height) {
  ReliefMap map = random_map(random, width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const auto k =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
      const double x = (2 * i + 1.0) / width - 1.0;
      const double y = (2 * j + 1.0) / height - 1.0;
      if (x * x + y * y > 1.0) map.mask[k] = map.slope_u[k] = map.slope_v[k] = 0.0F;
    }
  }
  count_pixels(map);
  return map;
}

/// All local maxima of the score by direct summation.
std::vector<Agreement> maxima_by_hand(const ReliefMap& a, const ReliefMap& b,
                                      const CorrelateOptions& options) {
  const float least = std::max(options.least_pixels,
                               options.least_overlap * static_cast<float>(std::min(a.pixels, b.pixels)));
  std::map<std::pair<int, int>, Agreement> all;
  for (int v = -b.height; v <= a.height; ++v) {
    for (int u = -b.width; u <= a.width; ++u) {
      Agreement now = agreement_at(a, b, u, v, options);
      if (now.pixels < least) now.score = 0.0F;
      all[{u, v}] = now;
    }
  }
  std::vector<Agreement> maxima;
  for (const auto& [place, now] : all) {
    const auto score = [&, u = place.first, v = place.second](int du, int dv) {
      const auto found = all.find({u + du, v + dv});
      return found == all.end() ? 0.0F : found->second.score;
    };
    if (now.score > std::max({0.0F, score(1, 0), score(-1, 0), score(0, 1), score(0, -1)}))
      maxima.push_back(now);
  }
  return maxima;
}

TEST(Correlate, EveryLocalMaximumOfMapsOfAnyShapeIsFoundAndNoOther) {
  Random random(15);
  CorrelateOptions options;
  options.most_peaks = 100000;
  const ReliefMap a = round_map(random, 37, 21);
  Correlator correlator(a, options);
  // Sides that lead to transforms of all radices, and repeat, so that fields grow, shrink and are kept.
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{9, 40}, {31, 12}, {60, 60}, {31, 12}, {100, 7}, {23, 23}}) {
    SCOPED_TRACE(width);
    const ReliefMap b = round_map(random, width, height);
    auto expected = maxima_by_hand(a, b, options);
    auto got = correlator.peaks(b);
    // Where slopes disagree and outlines do not meet the score is nought but for rounding.
    for (auto* maxima : {&expected, &got})
      std::erase_if(*maxima, [](const Agreement& a) { return a.score < 1e-3F; });
    ASSERT_EQ(got.size(), expected.size());
    const auto by_place = [](const Agreement& x, const Agreement& y) {
      return std::pair(x.shift_u, x.shift_v) < std::pair(y.shift_u, y.shift_v);
    };
    std::ranges::sort(expected, by_place);
    std::ranges::sort(got, by_place);
    for (std::size_t k = 0; k < got.size(); ++k) {
      EXPECT_EQ(got[k].shift_u, expected[k].shift_u);
      EXPECT_EQ(got[k].shift_v, expected[k].shift_v);
      EXPECT_NEAR(got[k].pixels, expected[k].pixels, 1e-2);  // as above
      EXPECT_NEAR(got[k].score, expected[k].score, 2e-2);
    }
  }
}

TEST(Correlate, FieldsAreShorterThanBothMapsTogether) {
  // A disc overlaps another by a quarter of its width before 15 % of its pixels do.
  Random random(16);
  const ReliefMap a = round_map(random, 52, 52);
  const ReliefMap b = round_map(random, 52, 52);
  Correlator correlator(a, {.least_overlap = 0.15F});
  correlator.peaks(b);
  EXPECT_LE(correlator.shifts(), 100L * 100L);
}

TEST(Correlate, LongStripsThatShareATenthAreFound) {
  Random random(18);
  constexpr int kShared = 22;
  constexpr int kAcross = 6;
  constexpr int kLong = 220;
  const ReliefMap a = random_map(random, kLong, kAcross);
  ReliefMap b = random_map(random, kLong, kAcross);
  for (int j = 0; j < kAcross; ++j) {
    for (int i = 0; i < kShared; ++i) {  // b begins where a ends
      const auto to = static_cast<std::size_t>(j * kLong + i);
      const std::size_t from = to + static_cast<std::size_t>(kLong - kShared);
      b.mask[to] = a.mask[from];
      b.slope_u[to] = a.slope_u[from];
      b.slope_v[to] = a.slope_v[from];
    }
  }
  count_pixels(b);
  Correlator correlator(a, CorrelateOptions{});
  const auto peaks = correlator.peaks(b);
  ASSERT_FALSE(peaks.empty());
  EXPECT_EQ(peaks.front().shift_u, kLong - kShared);
  EXPECT_EQ(peaks.front().shift_v, 0);
}

TEST(Correlate, OrderIsAPermutationThatKeepsLikeSizesTogether) {
  Random random(17);
  const Correlator correlator(random_map(random, 20, 20), CorrelateOptions{});
  const std::vector<ReliefMap> maps = {random_map(random, 30, 9), random_map(random, 12, 30),
                                       random_map(random, 30, 9), random_map(random, 12, 30)};
  const auto order = correlator.cheapest_order(maps);
  EXPECT_EQ(order, (std::vector<std::size_t>{1, 3, 0, 2}));
}

TEST(Correlate, EveryInstructionSetGivesTheSameBits) {
  Random random(18);
  const ReliefMap a = round_map(random, 41, 29);
  const ReliefMap b = round_map(random, 26, 45);
  const auto peaks = [&] { return Correlator(a, CorrelateOptions{}).peaks(b); };
  const auto first = peaks();
  ASSERT_FALSE(first.empty());
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const auto again = peaks();
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      EXPECT_EQ(again[k].shift_u, first[k].shift_u);
      EXPECT_EQ(again[k].shift_v, first[k].shift_v);
      EXPECT_EQ(again[k].score, first[k].score);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(FftPlan, LengthsAreMultiplesOfFourOfSmallFactorsAndHoldWhatWasAsked) {
  for (std::size_t least = 1; least < 1200; ++least) {
    const auto size = detail::fft_size(least, 2 * least);
    EXPECT_GE(size.width, least);
    EXPECT_GE(size.height, 2 * least);
    std::size_t length = 1;
    const detail::FftPlan plan = detail::plan_fft(size.width);
    EXPECT_EQ(plan.stages.front().radix, 4);
    EXPECT_GE(plan.stages.size(), 2U);
    for (const auto& stage : plan.stages) length *= static_cast<std::size_t>(stage.radix);
    EXPECT_EQ(length, size.width);
  }
}

}  // namespace
}  // namespace rejoin::match
