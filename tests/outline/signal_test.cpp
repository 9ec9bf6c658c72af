#include "outline/signal.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "core/smooth.hpp"
#include "shapes.hpp"

namespace rejoin::outline {
namespace {

TEST(Signal, ResamplingIsEvenByArcLength) {
  const std::vector<glm::dvec2> rectangle{{0, 0}, {3, 0}, {3, 1}, {0, 1}};
  const auto points = resample(rectangle, 16);
  EXPECT_EQ(points[0], rectangle[0]);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(glm::distance(points[i], points[(i + 1) % points.size()]), 0.5, 1e-12);
}

TEST(Signal, CurvatureOfACircleIsOneOverItsRadius) {
  for (const double k : curvature(testing::circle(5.0, 400))) EXPECT_NEAR(k, 0.2, 1e-4);
  auto backwards = testing::circle(5.0, 400);
  std::reverse(backwards.begin(), backwards.end());
  for (const double k : curvature(backwards)) EXPECT_NEAR(k, -0.2, 1e-4);
}

// A Gaussian of deviation s takes a wave of wave number w down by exp(-s^2 w^2 / 2).
TEST(Signal, SmoothingDampsAWaveAsAGaussianDoes) {
  constexpr std::size_t kCount = 240;
  std::vector<double> wave;
  for (std::size_t i = 0; i < kCount; ++i)
    wave.push_back(std::sin(2.0 * M_PI * 10.0 * static_cast<double>(i) / kCount));
  const double deviation = 4.0;
  const double w = 2.0 * M_PI * 10.0 / kCount;
  const auto smoothed = smooth(wave, deviation);
  const double damping = std::exp(-0.5 * deviation * deviation * w * w);
  for (std::size_t i = 0; i < kCount; ++i)
    EXPECT_NEAR(smoothed[i], damping * wave[i], 1e-3);  // the tail beyond 3.5 deviations
}

TEST(Signal, TurningOfEveryScaleAddsUpToAFullTurn) {
  Outline outline;
  outline.points = testing::broken_tile(200, 100, {}, 4).lower.points;
  for (const ScaleSignal& scale : scale_space(outline.points, {2.0, 4})) {
    const double sum = std::accumulate(scale.turning.begin(), scale.turning.end(), 0.0);
    EXPECT_NEAR(sum, 2.0 * M_PI, 1e-4);
  }
}

TEST(Signal, EachScaleIsTwiceAsCoarseAndKnowsItsPlaces) {
  Outline outline;
  outline.points = testing::circle(100.0, 2000);
  const auto scales = scale_space(outline.points, {2.0, 4});
  const double length = perimeter(outline.points);
  for (std::size_t k = 0; k < scales.size(); ++k) {
    EXPECT_NEAR(scales[k].step, 2.0 * std::pow(2.0, static_cast<double>(k)), 0.2);
    const auto lengths = arc_lengths(outline.points);
    for (std::size_t i = 0; i < scales[k].points.size(); ++i) {
      EXPECT_LT(scales[k].places[i], length);
      // Smoothing draws a circle in by half its curvature times the variance, and moves nothing along it.
      const glm::dvec2 own = point_at(outline.points, lengths, scales[k].places[i]);
      EXPECT_LT(glm::distance(glm::normalize(own), glm::normalize(scales[k].points[i])), 2e-3);
    }
  }
}

TEST(Signal, BorderFarBelowTheStepIsItsMean) {
  constexpr double kSide = 1e-9;  // the whole kernel of such a step would take terabytes
  Outline outline;
  outline.points = {{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}};
  for (const ScaleSignal& scale : scale_space(outline.points, {1.0, 2})) {
    for (const glm::dvec2& point : scale.points)
      EXPECT_LT(glm::distance(point, {0.5 * kSide, 0.5 * kSide}), 0.01 * kSide);
  }
}

TEST(Signal, NothingDependsOnTheUnit) {
  Outline small;
  small.points = testing::broken_tile(200, 100, {}, 5).lower.points;
  Outline large = small;
  for (glm::dvec2& p : large.points) p = p * 1024.0 + glm::dvec2(65536.0, -65536.0);
  const auto a = scale_space(small.points, {2.0, 3});
  const auto b = scale_space(large.points, {2048.0, 3});
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].turning.size(), b[k].turning.size());
    for (std::size_t i = 0; i < a[k].turning.size(); ++i) EXPECT_NEAR(a[k].turning[i], b[k].turning[i], 1e-5);
  }
}

}  // namespace
}  // namespace rejoin::outline
