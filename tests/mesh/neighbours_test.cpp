#include "mesh/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "mesh/detail/mean_normals.hpp"
#include "mesh/detail/neighbour_lists.hpp"
#include "mesh/point_index.hpp"
#include "random_points.hpp"

namespace rejoin::mesh {
namespace {

using test::random_point;

constexpr float kThin = 0.1F;

void expect_answers_of_point_index(const std::vector<glm::vec3>& points, float radius, float asked_size) {
  Random random(3);
  const PointIndex index(points);
  const Neighbours neighbours(points, radius);
  std::vector<std::uint32_t> expected;
  std::vector<std::uint32_t> found;
  std::size_t all = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const glm::vec3& asked : {points[k], random_point(random, asked_size, kThin)}) {
      index.within(asked, radius, expected);
      neighbours.of(asked, found);
      ASSERT_EQ(found, expected) << "point " << k << ", radius " << radius;
      found.clear();
      neighbours.each(asked, [&](std::uint32_t n) { found.push_back(n); });
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected);
      std::size_t seen = 0;
      EXPECT_EQ(neighbours.any(asked, [&](std::uint32_t) { return ++seen == 2; }), expected.size() > 1);
      EXPECT_EQ(seen, std::min<std::size_t>(2, expected.size()));
      all += found.size();
    }
  }
  EXPECT_GT(all, 2 * points.size());
}

TEST(Neighbours, AreThoseOfThePointIndexInAndAroundTheBox) {
  Random random(8);
  std::vector<glm::vec3> points(2000);
  for (glm::vec3& point : points) point = random_point(random, 1.0F, kThin) + glm::vec3(100.0F, 0.0F, -40.0F);
  expect_answers_of_point_index(points, 0.03F, 1.2F);
  expect_answers_of_point_index(points, 0.4F, 3.0F);
}

TEST(Neighbours, AreRightWhereFewPointsSpreadFar) {
  Random random(9);
  std::vector<glm::vec3> points(500);
  for (glm::vec3& point : points) point = random_point(random, 1.0F, kThin);
  points.emplace_back(1000.0F, -500.0F, 0.0F);
  expect_answers_of_point_index(points, 0.1F, 1.0F);
}

// Scans are dense here and there: lists of all neighbours would grow with the square of that.
TEST(Neighbours, OfManyAboutSoManyAreKeptEvenly) {
  std::vector<glm::vec3> points;
  for (int k = 0; k < 1000; ++k) points.emplace_back(0.001F * static_cast<float>(k), 0.0F, 0.0F);
  const detail::Lists all = detail::neighbours_within(points, 0.3);
  const detail::Lists some = detail::neighbours_within(points, 0.3, 50);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_GT(all[i].size(), 50U);
    EXPECT_LE(some[i].size(), 50U);
    EXPECT_GT(some[i].size(), 25U);
    EXPECT_TRUE(std::ranges::includes(all[i], some[i]));
    EXPECT_EQ(some[i].front(), all[i].front());
    EXPECT_GT(some[i].back(), all[i].back() - 15U);
  }
}

TEST(Neighbours, WithoutPointsThereAreNone) {
  std::vector<std::uint32_t> found{1, 2};
  Neighbours({}, 1.0F).of(glm::vec3(0.0F), found);
  EXPECT_TRUE(found.empty());
}

TEST(Neighbours, FarAwayThereAreNone) {
  const std::vector<glm::vec3> points{glm::vec3(0.0F), glm::vec3(1.0F)};
  const Neighbours neighbours(points, 1.0F);
  std::vector<std::uint32_t> found;
  for (const glm::vec3& far :
       {glm::vec3(1e30F, 0.0F, 0.0F), glm::vec3(0.0F, -1e30F, 0.0F), glm::vec3(0.5F, 0.5F, 3.5F)}) {
    neighbours.of(far, found);
    EXPECT_TRUE(found.empty());
  }
}

/// Whether fewer neighbours, asked one by one, are the first of the many that are kept.
void expect_fewer_to_be_the_first(const std::vector<glm::vec3>& points) {
  const PointIndex index(points);
  detail::CloudNeighbours neighbours(points);
  ASSERT_EQ(neighbours.wide().size(), points.size());
  std::vector<std::uint32_t> expected;
  for (std::size_t i = 0; i < points.size(); ++i) {
    index.nearest(points[i], detail::kNeighbours, expected);
    ASSERT_TRUE(std::ranges::equal(neighbours.near()[i], expected)) << i;
    for (const std::size_t fewer : {std::size_t{1}, std::size_t{7}, detail::kNeighbours}) {
      index.nearest(points[i], fewer, expected);
      ASSERT_TRUE(std::ranges::equal(neighbours.wide()[i].first(fewer), expected)) << i << ", " << fewer;
    }
  }
}

TEST(CloudNeighbours, FewerAreTheFirstOfMoreWhereManyLieEquallyFarToo) {
  Random random(11);
  std::vector<glm::vec3> points(3000);
  for (glm::vec3& point : points) point = random_point(random, 1.0F, kThin);
  expect_fewer_to_be_the_first(points);
  points.clear();
  for (int k = 0; k < 3000; ++k) points.emplace_back(k % 50, k / 50, 0);  // a depth camera's
  expect_fewer_to_be_the_first(points);
}

TEST(CloudNeighbours, OfFewPointsAreAll) {
  const std::vector<glm::vec3> points{{0, 0, 0}, {3, 0, 0}, {1, 0, 0}};
  detail::CloudNeighbours neighbours(points);
  ASSERT_EQ(neighbours.near().each(), 3U);
  EXPECT_TRUE(std::ranges::equal(neighbours.near()[0], std::vector<std::uint32_t>{0, 2, 1}));
  EXPECT_TRUE(std::ranges::equal(neighbours.wide()[1], std::vector<std::uint32_t>{1, 2, 0}));
}

}  // namespace
}  // namespace rejoin::mesh
