#include "mesh/point_index.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "random_points.hpp"

namespace rejoin::mesh {
namespace {

using test::random_point;

constexpr float kThinSlab = 0.1F;

/// By looking at every point.
std::optional<float> least_distance(const std::vector<glm::vec3>& points, const glm::vec3& to, float radius) {
  std::optional<float> least;
  for (const glm::vec3& point : points) {
    const float distance = glm::distance(point, to);
    if (distance < radius && (!least || distance < *least)) least = distance;
  }
  return least;
}

TEST(PointIndex, NearestWithinIsThatOfAllPointsOrNone) {
  Random random(7);
  std::vector<glm::vec3> points(3000);
  for (glm::vec3& point : points) point = random_point(random, 1.0F, kThinSlab);
  const PointIndex index(points);
  int hits = 0;
  constexpr int kAsked = 2000;
  for (int k = 0; k < kAsked; ++k) {
    const glm::vec3 asked = random_point(random, 1.5F, kThinSlab);
    const auto radius = static_cast<float>(0.1 * random.uniform());
    const auto least = least_distance(points, asked, radius);
    const auto found = index.nearest_within(asked, radius);
    ASSERT_EQ(found.has_value(), least.has_value()) << "point " << k << ", radius " << radius;
    if (!found) continue;
    ++hits;
    EXPECT_FLOAT_EQ(found->second, *least);
    EXPECT_FLOAT_EQ(glm::distance(points[found->first], asked), *least);
  }
  EXPECT_GT(hits, kAsked / 10);
  EXPECT_LT(hits, kAsked * 9 / 10);
}

TEST(PointIndex, WhatIsKnownOfTheLastLookChangesNoAnswer) {
  Random random(9);
  std::vector<glm::vec3> points(3000);
  for (glm::vec3& point : points) point = random_point(random, 1.0F, kThinSlab);
  points.insert(points.end(), points.begin(),
                points.begin() + 300);  // of two in one place either may be nearest
  const PointIndex index(points);
  int known_hits = 0;
  int known_misses = 0;
  for (int walk = 0; walk < 300; ++walk) {
    glm::vec3 asked = random_point(random, 1.5F, kThinSlab);
    PointIndex::Known known;
    for (int k = 0; k < 30; ++k) {
      const auto radius = static_cast<float>(0.02 + 0.08 * random.uniform());
      const glm::vec3 place = known.place;
      const auto found = index.nearest_within(asked, radius, known);
      ASSERT_EQ(found, index.nearest_within(asked, radius)) << "walk " << walk << ", step " << k;
      if (known.place == place) ++(found ? known_hits : known_misses);
      asked += random_point(random, k % 5 == 0 ? 0.1F : 0.002F);
    }
  }
  EXPECT_GT(known_hits, 500);  // searched anew at every step it is none
  EXPECT_GT(known_misses, 500);
}

TEST(PointIndex, EveryInstructionSetFindsTheSame) {
  Random random(10);
  std::vector<glm::vec3> points(2000);
  for (glm::vec3& point : points) point = glm::round(16.0F * random_point(random, 1.0F)) / 16.0F;
  const PointIndex index(points);
  std::vector<glm::vec3> asked(1000);  // on a lattice, as the points: many are as near to several
  for (glm::vec3& point : asked) point = glm::round(32.0F * random_point(random, 1.0F)) / 32.0F;
  const auto answers = [&] {
    std::vector<std::optional<std::pair<std::uint32_t, float>>> all;
    for (const glm::vec3& point : asked) {
      PointIndex::Known known;
      all.push_back(index.nearest_within(point, 0.1F));
      all.push_back(index.nearest_within(point, 0.1F, known));
      all.emplace_back(std::pair(known.nearest.value_or(0), known.room));
    }
    return all;
  };
  const auto first = answers();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_EQ(answers(), first);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(PointIndex, NearestIsThatOfAllPointsForAnyNumberOfThem) {
  Random random(8);
  for (std::size_t count = 1; count < 300; ++count) {
    std::vector<glm::vec3> points(count);
    for (glm::vec3& point : points) point = random_point(random, 1.0F);
    if (count % 3 == 0) {  // in one plane, and some twice
      for (glm::vec3& point : points) point.y = 0.25F;
      points.insert(points.end(), points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count / 2));
    }
    const PointIndex index(points);
    for (int k = 0; k < 20; ++k) {
      const glm::vec3 asked = random_point(random, k < 10 ? 1.0F : 10.0F);
      const auto found = index.nearest(asked);
      ASSERT_TRUE(found) << count << " points";
      const float least =
          least_distance(points, asked, std::numeric_limits<float>::infinity()).value_or(-1.0F);
      EXPECT_FLOAT_EQ(found->second, least) << count << " points";
      EXPECT_FLOAT_EQ(glm::distance(points[found->first], asked), least) << count << " points";
    }
  }
}

TEST(PointIndex, ManyEqualPointsAreOne) {
  const PointIndex index(std::vector<glm::vec3>(1000, glm::vec3(1, 2, 3)));
  const auto found = index.nearest_within({1, 2, 4}, 1.5F);
  ASSERT_TRUE(found);
  EXPECT_FLOAT_EQ(found->second, 1.0F);
  EXPECT_FALSE(index.nearest_within({1, 2, 4}, 1.0F));
}

TEST(PointIndex, WithoutPointsNothingIsNear) {
  const PointIndex index({});
  EXPECT_FALSE(index.nearest_within(glm::vec3(0.0F), 1.0F));
  EXPECT_FALSE(index.nearest(glm::vec3(0.0F)));
}

}  // namespace
}  // namespace rejoin::mesh
