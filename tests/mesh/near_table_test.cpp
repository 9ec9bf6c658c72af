#include "mesh/near_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "mesh/point_index.hpp"
#include "random_points.hpp"

namespace rejoin::mesh {
namespace {

using test::random_point;

constexpr float kTableCell = 0.05F;
constexpr float kReach = 0.2F;
const float kDiagonal = std::sqrt(3.0F) * kTableCell;

/// On a ball, about a cell apart.
std::vector<glm::vec3> ball() {
  Random random(4);
  std::vector<glm::vec3> points(1500);
  for (glm::vec3& point : points) point = glm::normalize(random_point(random, 1.0F));
  return points;
}

TEST(NearTable, FindsWhatIsInReachAtNearlyTheLeastDistance) {
  const auto points = ball();
  const PointIndex index(points);
  const NearTable table(points, kTableCell, kReach);
  Random random(5);
  double beyond = 0;
  int hits = 0;
  for (int k = 0; k < 5000; ++k) {
    const glm::vec3 asked = random_point(random, 2.6F);
    const auto nearest = index.nearest_within(asked, kReach);
    const auto found = table.nearest_within(asked, kReach);
    if (!found) {
      const float least = nearest ? nearest->second : kReach;
      EXPECT_GT(least, kReach - 2.0F * kDiagonal);
      continue;
    }
    ASSERT_TRUE(nearest);
    EXPECT_FLOAT_EQ(found->second, glm::distance(points[found->first], asked));
    EXPECT_LT(found->second, nearest->second + 2.0F * kDiagonal);
    beyond += static_cast<double>(found->second - nearest->second);
    ++hits;
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(beyond / hits, 0.15 * static_cast<double>(kTableCell));
}

TEST(NearTable, FindsNothingBeyondTheRadius) {
  const auto points = ball();
  const NearTable table(points, kTableCell, kReach);
  const glm::vec3 inside = 0.9F * points.front();
  ASSERT_TRUE(table.nearest_within(inside, kReach));
  EXPECT_FALSE(table.nearest_within(inside, 0.05F));
  EXPECT_FALSE(table.nearest_within(glm::vec3(0.0F), kReach));
}

TEST(NearTable, FarPointsAndNoNumbersFindNothing) {
  const NearTable table(ball(), kTableCell, kReach);
  const float none = std::nanf("");
  for (const glm::vec3& far :
       {glm::vec3(1e30F, 0.0F, 0.0F), glm::vec3(0.0F, -1e30F, 0.0F), glm::vec3(none)}) {
    EXPECT_FALSE(table.nearest_within(far, kReach));
  }
}

TEST(NearTable, HoldsPointsThatSpreadFar) {
  auto points = ball();
  points.emplace_back(0.0F, 5000.0F, 0.0F);
  const NearTable table(points, kTableCell, kReach);
  for (std::size_t k = 0; k < points.size(); k += 100) EXPECT_TRUE(table.nearest_within(points[k], 100.0F));
  EXPECT_EQ(table.nearest_within(points.back(), 1.0F)->first, points.size() - 1);
}

TEST(NearTable, WithoutPointsNothingIsNear) {
  EXPECT_FALSE(NearTable().nearest_within(glm::vec3(0.0F), 1.0F));
  EXPECT_FALSE(NearTable({}, kTableCell, kReach).nearest_within(glm::vec3(0.0F), 1.0F));
}

}  // namespace
}  // namespace rejoin::mesh
