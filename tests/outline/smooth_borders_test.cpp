#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/random.hpp"
#include "outline/detail/independence.hpp"
#include "outline/lcs.hpp"
#include "outline/multiscale.hpp"
#include "shapes.hpp"

namespace rejoin::outline {
namespace {

/// A circle of radius 300 with 60 waves and less round it, the longer the higher: nothing of it is shorter than 30 units, and a point
/// lies each 0.7.
Piece smooth_blob(std::uint64_t seed) {
  constexpr int kPoints = 3000;
  Random random(seed);
  std::vector<double> radii(kPoints, 300.0);
  for (int k = 1; k <= 60; ++k) {
    const double height = 20.0 * random.normal() / k;
    const double phase = random.uniform(0.0, 2.0 * M_PI);
    for (int i = 0; i < kPoints; ++i)
      radii[static_cast<std::size_t>(i)] += height * std::sin(2.0 * M_PI * k * i / kPoints + phase);
  }
  Piece piece;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * M_PI * i / kPoints;
    piece.outline.points.push_back(radii[static_cast<std::size_t>(i)] *
                                   glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return piece;
}

/// How many of the pairs of some smooth strangers a method calls a join.
int called_joins(Matcher& matcher) {
  std::vector<Piece> pieces;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) pieces.push_back(smooth_blob(seed));
  matcher.prepare(pieces);
  int count = 0;
  for (std::size_t a = 0; a < pieces.size(); ++a) {
    for (std::size_t b = a + 1; b < pieces.size(); ++b) {
      const auto candidates = matcher.match(a, b, Context()).candidates;
      if (!candidates.empty() && candidates[0].score >= kSureScore) ++count;
    }
  }
  return count;
}

TEST(SmoothBorders, StrangersAreNoJoinByMultiscale) {
  MultiscaleOptions options;  // as for a single pair
  options.min_length_share = 1.0 / 40.0;
  options.per_pair = 256;
  options.fitted = 256;
  options.per_coarse_scale = 16;
  EXPECT_EQ(called_joins(*make_multiscale(options)), 0);
}

TEST(SmoothBorders, StrangersAreNoJoinByLcs) {
  EXPECT_EQ(called_joins(*make_lcs()), 0);
}

TEST(SmoothBorders, TwoSidesOfASmoothBreakAreAJoin) {
  std::vector<glm::dvec2> line;  // 20 waves and less of 30 units and more
  Random random(8);
  for (int i = 0; i <= 600; ++i) line.emplace_back(i, 0.0);
  for (int k = 1; k <= 20; ++k) {
    const double height = 15.0 * random.normal() / k;
    for (glm::dvec2& p : line) p.y += height * std::sin(M_PI * k * p.x / 300.0);
  }
  Piece lower;
  Piece upper;
  testing::add_run(lower.outline.points, {0, -150}, {600, -150});
  testing::add_run(lower.outline.points, {600, -150}, line.back());
  lower.outline.points.insert(lower.outline.points.end(), line.rbegin(), line.rend() - 1);
  testing::add_run(lower.outline.points, line.front(), {0, -150});
  upper.outline.points.assign(line.begin(), line.end() - 1);
  testing::add_run(upper.outline.points, line.back(), {600, 150});
  testing::add_run(upper.outline.points, {600, 150}, {0, 150});
  testing::add_run(upper.outline.points, {0, 150}, line.front());
  const std::vector<Piece> pieces{lower, upper};
  std::vector<std::unique_ptr<Matcher>> matchers;
  matchers.push_back(make_multiscale());
  matchers.push_back(make_lcs());
  for (const auto& matcher : matchers) {
    matcher->prepare(pieces);
    const auto candidates = matcher->match(0, 1, Context()).candidates;
    ASSERT_FALSE(candidates.empty());
    EXPECT_GE(candidates[0].score, kSureScore);
    EXPECT_NEAR(candidates[0].boundary.length, 640.0, 40.0);
  }
}

std::vector<double> noise(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(random.normal());
  return values;
}

/// Means of as many neighbours as said.
std::vector<double> running_mean(const std::vector<double>& values, std::size_t width) {
  std::vector<double> means;
  for (std::size_t i = 0; i + width <= values.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = i; k < i + width; ++k) sum += values[k] / static_cast<double>(width);
    means.push_back(sum);
  }
  return means;
}

TEST(IndependentSamples,
     ThoseOfNoiseAreAllAndThoseOfItsRunningMeanAsManyAsTheVarianceOfTheirCorrelationSays) {
  constexpr std::size_t kCount = 400;
  constexpr std::size_t kWidth = 20;
  double white = 0.0;
  double smooth = 0.0;
  double squares = 0.0;
  constexpr int kTrials = 200;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const std::vector<double> a = noise(kCount, 2 * trial + 1);
    const std::vector<double> b = noise(kCount, 2 * trial + 2);
    white += detail::independent_samples(a, b) / kTrials;
    const std::vector<double> mean_a = running_mean(a, kWidth);
    const std::vector<double> mean_b = running_mean(b, kWidth);
    smooth += detail::independent_samples(mean_a, mean_b) / kTrials;
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    double sum_a = 0.0;
    double sum_b = 0.0;
    for (std::size_t i = 0; i < mean_a.size(); ++i) {
      sum_a += mean_a[i];
      sum_b += mean_b[i];
      ab += mean_a[i] * mean_b[i];
      aa += mean_a[i] * mean_a[i];
      bb += mean_b[i] * mean_b[i];
    }
    const auto n = static_cast<double>(mean_a.size());
    const double covariance = ab - sum_a * sum_b / n;
    squares += covariance * covariance / ((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n)) / kTrials;
  }
  EXPECT_GT(white, 0.9 * kCount);
  // The squared correlation of unrelated series is 1 / n on average; over 200 trials that is off by a tenth (root of 2 / 200).
  EXPECT_NEAR(smooth, 1.0 / squares, 0.35 / squares);
  EXPECT_LT(smooth, 2.0 * kCount / kWidth);
}

TEST(IndependentSamples, AConstantHasNone) {
  const std::vector<double> constant(50, 1.0);
  EXPECT_EQ(detail::independent_samples(constant, noise(50, 3)), 0.0);
}

}  // namespace
}  // namespace rejoin::outline
