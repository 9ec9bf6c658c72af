#include "match/detail/shape.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/random.hpp"

namespace rejoin::match::detail {
namespace {

// The definition: every point's value less the mean of all values closer to it than the radius.
TEST(VariancesByScale, AreThoseOfAllPairsOfPoints) {
  Random random(5);
  std::vector<glm::dvec3> points(400);
  std::array<std::vector<double>, 2> values;
  for (glm::dvec3& point : points) {
    point = {random.uniform(0.0, 20.0), random.uniform(0.0, 10.0), random.uniform(0.0, 1.0)};
    values[0].push_back(std::sin(point.x));
    values[1].push_back(random.uniform(-1.0, 1.0));
  }
  const std::array radii{1.0, 4.0};
  const auto found = variances_by_scale(points, {values[0], values[1]}, radii);
  for (std::size_t v = 0; v < values.size(); ++v) {
    std::vector<double> expected;
    for (const double radius : radii) {
      std::vector<double> left;
      for (std::size_t i = 0; i < points.size(); ++i) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t j = 0; j < points.size(); ++j) {
          if (glm::distance(points[i], points[j]) >= radius) continue;
          sum += values[v][j];
          count += 1.0;
        }
        left.push_back(values[v][i] - sum / count);
      }
      expected.push_back(std::pow(robust_deviation(left), 2.0));
    }
    expected.push_back(std::pow(robust_deviation(values[v]), 2.0));
    ASSERT_EQ(found[v].size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[v][k], expected[k], 1e-9);
  }
}

// Waves are left by the means of surroundings larger than they are, and gone from those of smaller ones.
TEST(VariancesByScale, OfWavesAreSmallBelowTheirLength) {
  std::vector<glm::dvec3> points;
  std::vector<double> values;
  for (int x = 0; x < 80; ++x) {
    for (int y = 0; y < 20; ++y) {
      points.emplace_back(0.25 * x, 0.25 * y, 0.0);
      values.push_back(std::sin(points.back().x));
    }
  }
  const auto found = variances_by_scale(points, {values, values}, std::array{0.6, 4.0})[0];
  EXPECT_LT(found[0], 0.05 * found[2]);
  EXPECT_GT(found[1], 0.5 * found[2]);
}

}  // namespace
}  // namespace rejoin::match::detail
