#include "mesh/table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "mesh/bodies.hpp"
#include "shapes.hpp"
#include "table_scene.hpp"

namespace rejoin::mesh {
namespace {

double share_of_table(const Mesh& mesh) {
  const std::optional<Table> table = find_table(mesh);
  return table ? table->share : 0;
}

TEST(Table, PlaneBeyondThePieceOnItIsOne) {
  const auto lump = [](float x, float y) { return 50.0F - std::hypot(x - 10.0F, y); };
  const double share =
      share_of_table(test::relief([&](float x, float y) { return std::max(0.0F, lump(x, y)); }));
  EXPECT_NEAR(share, 0.74, 0.05);  // 1 - 0.25 pi 0.25 of the plane, where the lump has sqrt(2) times that
  EXPECT_EQ(share_of_table(test::relief(lump)), 0);
}

TEST(Table, PlaneThatHangsTogetherWithNothingIsOneWhicheverWayItFaces) {
  Mesh plane = test::moved(test::plate(150), {0, 0, -50.5F});
  EXPECT_GT(share_of_table(test::together(test::icosphere(50, 3), plane)), 0.7);
  plane.faces = {{0, 2, 1}, {0, 3, 2}};
  EXPECT_GT(share_of_table(test::together(test::icosphere(50, 3), plane)), 0.7);
  EXPECT_TRUE(bodies(test::together(test::icosphere(50, 3), plane)).empty());
}

TEST(Table, IsKnownBelowAPieceThatIsFlatItself) {
  const auto off_middle = [](float x, float y) { return std::max(std::abs(x), std::abs(y)); };
  EXPECT_GT(
      share_of_table(test::relief([&](float x, float y) { return off_middle(x, y) < 75 ? 40.0F : 0.0F; })),
      0.2);
  const auto tilted = [&](float x, float y) { return off_middle(x, y) < 60 ? 40.0F + 0.25F * x : 0.0F; };
  EXPECT_GT(share_of_table(test::relief(tilted)), 0.2);
}

TEST(Table, FloorsAndUndersidesAreNone) {
  EXPECT_EQ(share_of_table(test::box({100, 80, 20}, 10)), 0);
  EXPECT_EQ(share_of_table(test::box({200, 100, 5}, 4)), 0);
  EXPECT_EQ(
      share_of_table(test::relief([](float x, float y) { return std::max(0.0F, std::hypot(x, y) - 80.0F); })),
      0);  // a plate
  EXPECT_EQ(share_of_table(test::relief([](float, float) { return 0.0F; })), 0);
}

// The height of the tops and their share of the scan are those of sherds: a layer of a hundredth of the scan would hold them.
TEST(Table, IsFoundBelowThinFlatSherdsWhereverItLies) {
  Random random(3);
  const auto noise = [&random] { return 0.1F * static_cast<float>(random.normal()); };
  Mesh scan = test::relief(
      [&](float x, float y) {
        const bool sherd = std::abs(std::abs(x) - 45.0F) < 30.0F && std::abs(std::abs(y) - 45.0F) < 30.0F;
        return (sherd ? 4.0F : 0.0F) + noise();
      },
      200);
  const glm::dmat3 turn(glm::dvec3(0.36, 0.48, -0.8), glm::dvec3(-0.8, 0.6, 0), glm::dvec3(0.48, 0.64, 0.6));
  for (glm::vec3& vertex : scan.vertices) vertex = glm::vec3(turn * glm::dvec3(vertex)) + 5.0F;
  const auto check = [&](const Mesh& seen) {
    const std::optional<Table> table = find_table(seen);
    ASSERT_TRUE(table);
    EXPECT_GT(glm::dot(table->up, turn[2]), std::cos(1e-3));  // a fifth of the noise, at the border
    EXPECT_NEAR(table->height, glm::dot(glm::dvec3(5.0), turn[2]), 0.05);
    EXPECT_NEAR(table->share, 0.64, 0.05);
  };
  check(scan);
  scan.faces.clear();
  check(scan);  // the points alone
}

}  // namespace
}  // namespace rejoin::mesh
