#include "rims/closed_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/smooth.hpp"

namespace rejoin::rims {
namespace {

/// Corners at distance 1 on the axes: 0, 1 = +-x, 2, 3 = +-y, 4, 5 = +-z.
mesh::Mesh octahedron() {
  mesh::Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

std::vector<float> height_above(const mesh::Mesh& mesh, float level) {
  std::vector<float> values;
  for (const glm::vec3& v : mesh.vertices) values.push_back(v.z - level);
  return values;
}

double signed_area_from_above(const ClosedCurve& curve) {
  double sum = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const glm::dvec3& next = curve[(i + 1) % curve.size()];
    sum += 0.5 * (curve[i].x * next.y - curve[i].y * next.x);
  }
  return sum;
}

TEST(ZeroCurves, OfAHeightIsALevelLineWithTheUpperPartOnItsLeft) {
  const mesh::Mesh mesh = octahedron();
  const auto curves = zero_curves(mesh, height_above(mesh, 0.25F));
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_NEAR(length_of(curves[0]), 4.0 * 0.75 * std::sqrt(2.0), 1e-6);
  for (const glm::dvec3& p : curves[0]) EXPECT_NEAR(p.z, 0.25, 1e-6);
  // Seen from outside the curve runs around the axis counter-clockwise: what is higher is on its left.
  EXPECT_NEAR(signed_area_from_above(curves[0]), 2.0 * 0.75 * 0.75, 1e-6);
}

TEST(ZeroCurves, ThatEndAtAHoleAreLeftOut) {
  mesh::Mesh mesh = octahedron();
  mesh.faces.erase(mesh.faces.begin());
  EXPECT_TRUE(zero_curves(mesh, height_above(mesh, 0.25F)).empty());
}

TEST(ZeroCurves, OfAFunctionOfOneSignAreNone) {
  const mesh::Mesh mesh = octahedron();
  EXPECT_TRUE(zero_curves(mesh, height_above(mesh, 2.0F)).empty());
}

TEST(ClosedCurve, ResampledPointsLieAtEqualArcLength) {
  const ClosedCurve square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const ClosedCurve points = resampled(square, 16);
  ASSERT_EQ(points.size(), 16U);
  EXPECT_NEAR(length_of(points), 4.0, 1e-12);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(glm::distance(points[i], points[(i + 1) % points.size()]), 0.25, 1e-12);
}

TEST(ClosedCurve, SmoothingShrinksACircleAsTheGaussianSays) {
  ClosedCurve circle;
  constexpr int kCount = 200;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2.0 * M_PI * i / kCount;
    circle.push_back({std::cos(angle), std::sin(angle), 0.0});
  }
  constexpr double kDeviation = 6.0;
  const double angle = 2.0 * M_PI * kDeviation / kCount;
  // The Gaussian is cut at 3.5 deviations, which takes 0.05 % of its weight.
  for (const glm::dvec3& p : smooth(circle, kDeviation))
    EXPECT_NEAR(glm::length(p), std::exp(-0.5 * angle * angle), 5e-4);
}

}  // namespace
}  // namespace rejoin::rims
