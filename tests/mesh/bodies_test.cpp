#include "mesh/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapes.hpp"
#include "table_scene.hpp"

namespace rejoin::mesh {
namespace {

using test::moved;
using test::together;

/// The faces of a mesh that look along `direction`, within 60 degrees.
Mesh side(const Mesh& mesh, const glm::vec3& direction) {
  const std::vector<glm::vec3> normals = face_normals(mesh);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (glm::dot(normals[f], direction) > 0.5F) chosen.push_back(f);
  }
  return submesh(mesh, chosen);
}

TEST(Bodies, PiecesSideBySideAreTwoAndOneIsNone) {
  const Mesh one = test::box({40, 30, 20}, 8);
  EXPECT_TRUE(bodies(one).empty());
  const std::vector<double> shares = bodies(together(one, moved(test::box({40, 30, 20}, 8), {43, 10, 5})));
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_NEAR(shares[0], 0.5, 1e-6);
  EXPECT_NEAR(shares[1], 0.5, 1e-6);
}

TEST(Bodies, LyingAcrossTheAxesTheyAreTwoAsWell) {
  Mesh slabs =
      together(moved(test::box({100, 10, 10}, 8), {0, 8, 0}), moved(test::box({100, 10, 10}, 8), {0, -8, 0}));
  for (glm::vec3& v : slabs.vertices)
    v = glm::vec3(v.x - v.y, v.x + v.y, v.z) * std::sqrt(0.5F);  // their boxes overlap
  EXPECT_EQ(bodies(slabs).size(), 2U);
}

TEST(Bodies, ThreeWithOneInAnotherAreTwo) {
  const Mesh hollow = together(test::icosphere(20, 3), test::icosphere(15, 3));
  const std::vector<double> shares = bodies(together(hollow, moved(test::icosphere(10, 3), {40, 0, 0})));
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_NEAR(shares[0], 625.0 / 725.0, 0.01);
}

TEST(Bodies, ClosedOnesThatCrossAreTwo) {
  const Mesh stand = moved(test::box({30, 30, 5}, 8), {3, 2, 28});
  EXPECT_EQ(bodies(together(test::icosphere(30, 3), stand)).size(), 2U);
}

TEST(Bodies, SidesOfOneSherdAreOne) {
  const Mesh shell = test::icosphere(60, 4);
  Mesh inner = side(shell, {0, 0, 1});
  for (glm::vec3& v : inner.vertices) v *= 0.9F;
  for (glm::uvec3& face : inner.faces) std::swap(face.y, face.z);
  EXPECT_TRUE(bodies(together(side(shell, {0, 0, 1}), inner)).size() < 2);  // bent, its inside in its outside
  EXPECT_TRUE(bodies(together(side(shell, {0, 0, 1}), side(shell, {0, 0, -1}))).size() < 2);  // without a rim
}

TEST(Bodies, CrumbsAreNone) {
  EXPECT_TRUE(bodies(together(test::icosphere(30, 3), moved(test::icosphere(5, 2), {40, 0, 0}))).empty());
}

}  // namespace
}  // namespace rejoin::mesh
