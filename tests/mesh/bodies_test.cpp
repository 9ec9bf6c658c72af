#include "mesh/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

Mesh moved(Mesh mesh, const glm::vec3& by) {
  for (glm::vec3& vertex : mesh.vertices) vertex += by;
  return mesh;
}

Mesh together(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const glm::uvec3& face : b.faces) a.faces.push_back(face + first);
  return a;
}

/// The faces of a mesh that look along `direction`, within 60 degrees.
Mesh side(const Mesh& mesh, const glm::vec3& direction) {
  const std::vector<glm::vec3> normals = face_normals(mesh);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    if (glm::dot(normals[f], direction) > 0.5F) chosen.push_back(f);
  }
  return submesh(mesh, chosen);
}

/// z over (x, y) in -100 .. 100, seen from above.
Mesh relief(const std::function<float(float, float)>& height) {
  constexpr int kCells = 80;
  Mesh mesh;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      const float x = 200.0F * static_cast<float>(i) / kCells - 100.0F;
      const float y = 200.0F * static_cast<float>(j) / kCells - 100.0F;
      mesh.vertices.emplace_back(x, y, height(x, y));
    }
  }
  for (std::uint32_t i = 0; i < kCells; ++i) {
    for (std::uint32_t j = 0; j < kCells; ++j) {
      const std::uint32_t k = i * (kCells + 1) + j;
      mesh.faces.emplace_back(k, k + kCells + 1, k + kCells + 2);
      mesh.faces.emplace_back(k, k + kCells + 2, k + 1);
    }
  }
  return mesh;
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

TEST(Table, PlaneBeyondThePieceOnItIsOne) {
  const auto lump = [](float x, float y) { return 50.0F - std::hypot(x - 10.0F, y); };
  const double share = table(relief([&](float x, float y) { return std::max(0.0F, lump(x, y)); }));
  EXPECT_NEAR(share, 0.74, 0.05);  // 1 - 0.25 pi 0.25 of the plane, where the lump has sqrt(2) times that
  EXPECT_EQ(table(relief(lump)), 0);
}

TEST(Table, PlaneThatHangsTogetherWithNothingIsOneWhicheverWayItFaces) {
  Mesh plane;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
    plane.vertices.emplace_back(150.0F * corner, -50.5F);
  plane.faces = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_GT(table(together(test::icosphere(50, 3), plane)), 0.7);
  plane.faces = {{0, 2, 1}, {0, 3, 2}};
  EXPECT_GT(table(together(test::icosphere(50, 3), plane)), 0.7);
  EXPECT_TRUE(bodies(together(test::icosphere(50, 3), plane)).empty());
}

TEST(Table, IsKnownBelowAPieceThatIsFlatItself) {
  const auto off_middle = [](float x, float y) { return std::max(std::abs(x), std::abs(y)); };
  EXPECT_GT(table(relief([&](float x, float y) { return off_middle(x, y) < 75 ? 40.0F : 0.0F; })), 0.2);
  const auto tilted = [&](float x, float y) { return off_middle(x, y) < 60 ? 40.0F + 0.25F * x : 0.0F; };
  EXPECT_GT(table(relief(tilted)), 0.2);
}

TEST(Table, FloorsAndUndersidesAreNone) {
  EXPECT_EQ(table(test::box({100, 80, 20}, 10)), 0);
  EXPECT_EQ(table(test::box({200, 100, 5}, 4)), 0);
  EXPECT_EQ(table(relief([](float x, float y) { return std::max(0.0F, std::hypot(x, y) - 80.0F); })),
            0);  // a plate
  EXPECT_EQ(table(relief([](float, float) { return 0.0F; })), 0);
}

}  // namespace
}  // namespace rejoin::mesh
