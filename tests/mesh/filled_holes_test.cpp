#include "mesh/filled_holes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kRadius = 50;

bool is_under_the_cap(const glm::vec3& p, float height) {
  return p.z > height;
}

/// Sphere whose points a scanner has put off by a deviation along every axis, below a height alone.
Mesh scanned_below(float height, double deviation) {
  Random random(3);
  Mesh mesh = test::icosphere(kRadius, 5);
  for (glm::vec3& v : mesh.vertices) {
    const glm::vec3 off(glm::dvec3(random.normal(), random.normal(), random.normal()) * deviation);
    if (!is_under_the_cap(v, height)) v += off;
  }
  return mesh;
}

double area_above(const Mesh& mesh, const std::vector<std::uint32_t>& faces, float height) {
  std::vector<std::uint32_t> above;
  for (const std::uint32_t f : faces)
    if (is_under_the_cap(mesh.vertices[mesh.faces[f].x], height)) above.push_back(f);
  return above.empty() ? 0.0 : surface_area(submesh(mesh, above));
}

TEST(FilledHoles, AreSmootherThanTheScannersNoise) {
  constexpr float kHeight = 40;  // a tenth of the sphere
  const Mesh mesh = scanned_below(kHeight, 0.2);
  const std::vector<std::uint32_t> found = filled_holes(mesh);
  ASSERT_FALSE(found.empty());
  const double cap = 2.0 * M_PI * kRadius * (kRadius - kHeight);
  // At its border two rings tell the one side from the other.
  EXPECT_GT(area_above(mesh, found, kHeight), 0.85 * cap);
  EXPECT_LT(surface_area(submesh(mesh, found)), 1.15 * cap);
}

TEST(FilledHoles, AreNoneInAScanThatIsAsNoisyEverywhere) {
  for (const double deviation : {0.02, 0.2, 0.5})
    EXPECT_TRUE(filled_holes(scanned_below(60, deviation)).empty());
}

// What a model has without a scanner's noise is shape: its smooth parts were not made up.
TEST(FilledHoles, AreNoneInAModelWithoutNoise) {
  Mesh mesh = test::icosphere(kRadius, 5);
  EXPECT_TRUE(filled_holes(mesh).empty());
  for (glm::vec3& v : mesh.vertices) {
    if (!is_under_the_cap(v, 20))
      v *= 1.0F + 0.01F * std::sin(1.1F * v.x) * std::sin(1.2F * v.y) * std::sin(0.9F * v.z);
  }
  EXPECT_TRUE(filled_holes(mesh).empty());
  EXPECT_TRUE(filled_holes(test::box({30, 20, 10}, 12)).empty());
}

}  // namespace
}  // namespace rejoin::mesh
