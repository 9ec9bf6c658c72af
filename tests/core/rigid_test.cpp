#include "core/rigid.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace rejoin {
namespace {

glm::dvec3 random_unit(Random& random) {
  return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

TEST(Rigid, InverseUndoesTheMotion) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Rigid motion{axis_rotation(random_unit(random), random.uniform(-3, 3)),
                       {random.normal(), random.normal(), random.normal()}};
    const glm::dvec3 point(random.normal(), random.normal(), random.normal());
    EXPECT_LT(glm::distance((inverse(motion) * motion)(point), point), 1e-12);
  }
}

TEST(Rigid, RotationBetweenTakesOneVectorToTheOther) {
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 from = random_unit(random);
    const glm::dvec3 to = i % 4 == 0 ? -from : random_unit(random);
    const glm::dmat3 turn = rotation_between(from, to);
    EXPECT_LT(glm::distance(turn * from, to), 1e-9);
    EXPECT_NEAR(glm::determinant(turn), 1.0, 1e-12);
  }
}

TEST(Rigid, AngleBetweenIsTheTurningAngle) {
  const Rigid turned{axis_rotation({0, 0, 1}, 0.3), {}};
  EXPECT_NEAR(angle_between(Rigid{}, turned), 0.3, 1e-12);
}

TEST(Rigid, FrameIsRightHanded) {
  Random random(9);
  for (int i = 0; i < 50; ++i) {
    const glm::dmat3 frame = frame_of(random_unit(random));
    EXPECT_NEAR(glm::determinant(frame), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace rejoin
