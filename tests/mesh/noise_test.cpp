#include "mesh/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kRadius = 50;

/// Sphere whose points a scanner has put off by a deviation along every axis.
Mesh scanned_sphere(double deviation) {
  Random random(3);
  Mesh mesh = test::icosphere(kRadius, 5);
  for (glm::vec3& v : mesh.vertices) {
    v += glm::vec3(glm::dvec3(random.normal(), random.normal(), random.normal()) * deviation);
  }
  return mesh;
}

TEST(Noise, IsThatOfTheScanner) {
  for (const double deviation : {0.05, 0.2, 0.5}) {
    const double found = noise(scanned_sphere(deviation));
    EXPECT_GT(found, 0.75 * deviation);  // of a quarter of the places it is less than of all
    EXPECT_LT(found, 1.0 * deviation);
  }
}

TEST(Noise, OfASmoothSurfaceIsNone) {
  const Mesh sphere = scanned_sphere(0.0);
  EXPECT_LT(noise(sphere), 0.001 * resolution(sphere));
  EXPECT_LT(noise(test::box({30, 20, 10}, 12)), 1e-6);  // edges and corners are fewer than three quarters
}

TEST(Noise, RoughBreaksAreNotNoise) {
  // A third of the surface is as rough as a break may be, three waves of it within 20 spacings; the rest is smooth.
  Mesh sphere = scanned_sphere(0.02);
  const double before = noise(sphere);
  for (glm::vec3& v : sphere.vertices) {
    if (v.z > kRadius / 3) v.z += 2.0F * std::sin(0.5F * v.x) * std::cos(0.5F * v.y);
  }
  EXPECT_LT(noise(sphere), 1.3 * before);
}

TEST(Noise, IsToldFromShapeThatThePointsAreTooFarApartFor) {
  const Mesh scan = scanned_sphere(0.3);
  EXPECT_TRUE(is_of_scanner(noise(scan), scan));
  // Waves as long as five spacings, all over, as far off a quadric as that noise.
  Mesh waves = scanned_sphere(0.01);
  const double wave = 2.0 * std::numbers::pi / (5.0 * resolution(waves));
  for (glm::vec3& v : waves.vertices) {
    const glm::dvec3 p(v);
    v *= 1.0F + static_cast<float>(0.03 * std::sin(wave * p.x) * std::sin(wave * p.y) * std::sin(wave * p.z));
  }
  EXPECT_GT(noise(waves), 0.1 * resolution(waves));
  EXPECT_FALSE(is_of_scanner(noise(waves), waves));
}

TEST(Noise, GrowsWithTheUnitAndKnowsNoPlace) {
  Mesh sphere = scanned_sphere(0.2);
  const double before = noise(sphere);
  for (glm::vec3& v : sphere.vertices) v = 1000.0F * v + glm::vec3(2e4F, -3e4F, 0.0F);
  EXPECT_NEAR(noise(sphere), 1000.0 * before, 1.0 * before);
}

/// Both sides of a wall, flat, whose points are farther apart (1) than the wall is thick (0.8).
Mesh thin_wall() {
  constexpr std::uint32_t kRow = 30;
  Mesh wall;
  for (const bool upper : {false, true}) {
    const auto first = static_cast<std::uint32_t>(wall.vertices.size());
    for (std::uint32_t i = 0; i < kRow * kRow; ++i)
      wall.vertices.emplace_back(i % kRow, i / kRow, upper ? 0.8F : 0.0F);
    for (std::uint32_t i = 0; i + kRow + 1 < kRow * kRow; ++i) {
      if (i % kRow + 1 == kRow) continue;
      const std::uint32_t p = first + i;
      wall.faces.push_back(upper ? glm::uvec3(p, p + 1, p + kRow) : glm::uvec3(p, p + kRow, p + 1));
      wall.faces.push_back(upper ? glm::uvec3(p + 1, p + kRow + 1, p + kRow)
                                 : glm::uvec3(p + 1, p + kRow, p + kRow + 1));
    }
  }
  return wall;
}

TEST(Noise, OfAThinWallKnowsOneSideOfIt) {
  EXPECT_LT(noise(thin_wall()), 1e-6);
}

TEST(Noise, OfAHandfulOfPointsIsUnknown) {
  EXPECT_EQ(noise(test::icosphere(1, 0)), 0.0);
}

}  // namespace
}  // namespace rejoin::mesh
