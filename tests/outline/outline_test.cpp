#include "outline/outline.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace rejoin::outline {
namespace {

Planar random_motion(Random& random) {
  return {random.uniform(-3, 3), {random.normal(), random.normal()}, random.below(2) == 1};
}

TEST(Planar, InverseUndoesTheMotion) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Planar motion = random_motion(random);
    const glm::dvec2 point(random.normal(), random.normal());
    EXPECT_LT(glm::distance((inverse(motion) * motion)(point), point), 1e-12);
    EXPECT_LT(glm::distance(motion(inverse(motion)(point)), point), 1e-12);
  }
}

TEST(Planar, ProductAppliesTheRightFactorFirst) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Planar a = random_motion(random);
    const Planar b = random_motion(random);
    const glm::dvec2 point(random.normal(), random.normal());
    EXPECT_LT(glm::distance((a * b)(point), a(b(point))), 1e-12);
  }
}

TEST(Planar, MatrixDoesTheSame) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Planar motion = random_motion(random);
    const glm::dvec2 point(random.normal(), random.normal());
    EXPECT_LT(glm::distance(glm::dvec2(matrix(motion) * glm::dvec3(point, 1.0)), motion(point)), 1e-12);
    EXPECT_NEAR(glm::determinant(matrix(motion)), motion.flipped ? -1.0 : 1.0, 1e-12);
  }
}

TEST(Planar, AngleBetweenWrapsAround) {
  EXPECT_NEAR(angle_between({3.0, {}, false}, {-3.0, {}, false}), 2.0 * M_PI - 6.0, 1e-12);
}

const std::vector<glm::dvec2> kSquare{{1e6, 0}, {1e6 + 2, 0}, {1e6 + 2, 2}, {1e6, 2}};

TEST(JoinCandidate, ExchangedBeginsAtTheOtherEndOfBothStretches) {
  JoinCandidate join;
  join.boundary = {10.0, 50.0, 22.0, 0, 0, 4.0};  // A from 10 to 30, B from 50 back to 26
  const Boundary back = exchanged(join, 100.0, 100.0).boundary;
  EXPECT_DOUBLE_EQ(back.begin_a, 26.0);
  EXPECT_DOUBLE_EQ(back.begin_b, 30.0);
  EXPECT_DOUBLE_EQ(back.length_a(), 24.0);
  EXPECT_DOUBLE_EQ(back.length_b(), 20.0);
  join.pose.flipped = true;  // B from 50 on to 74
  const Boundary along = exchanged(join, 100.0, 100.0).boundary;
  EXPECT_DOUBLE_EQ(along.begin_a, 50.0);
  EXPECT_DOUBLE_EQ(along.begin_b, 10.0);
  EXPECT_DOUBLE_EQ(along.length_a(), 24.0);
}

TEST(Polygon, AreaOfAFarSquareIsExact) {
  EXPECT_DOUBLE_EQ(signed_area(kSquare), 4.0);
  EXPECT_DOUBLE_EQ(signed_area({kSquare.rbegin(), kSquare.rend()}), -4.0);
}

TEST(Polygon, PointAtRunsAroundAndWraps) {
  const auto lengths = arc_lengths(kSquare);
  EXPECT_DOUBLE_EQ(perimeter(kSquare), 8.0);
  EXPECT_EQ(point_at(kSquare, lengths, 3.0), glm::dvec2(1e6 + 2, 1));
  EXPECT_EQ(point_at(kSquare, lengths, -1.0), glm::dvec2(1e6, 1));
  EXPECT_EQ(point_at(kSquare, lengths, 8.0), kSquare[0]);
}

}  // namespace
}  // namespace rejoin::outline
