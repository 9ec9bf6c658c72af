#include "match/verify.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "match/stability.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::flat_half;
using testing::make_pair;
using testing::Pair;

double slide_at(const Joint& joint, const Rigid& pose) {
  return probe(joint, pose, joint.evidence(pose, 0)).value().slide;
}

TEST(Stability, WavyCutHoldsAndPlaneSlides) {
  const Pair pair = make_pair(5);
  EXPECT_LT(slide_at(Joint(pair.a, pair.b), pair.truth), 0.2);
  const Fragment below = flat_half(true);
  const Fragment above = flat_half(false);
  EXPECT_GT(slide_at(Joint(below, above), Rigid{}), 0.8);
}

// A false pose may be carried farther than it was pushed.
TEST(Stability, SlideIsAShare) {
  const Pair pair = make_pair(5);
  const Joint joint(pair.a, pair.b);
  Random random(7);
  for (int k = 0; k < 12; ++k) {
    const Rigid off = testing::random_rigid(random, 8.0 * joint.tolerance());
    const Rigid pose =
        Rigid{axis_rotation({0, 0, 1}, random.uniform(-0.3, 0.3)), off.translation} * pair.truth;
    const auto stability = probe(joint, pose, joint.evidence(pose, 0));
    if (!stability) continue;
    EXPECT_GE(stability->slide, 0.0);
    EXPECT_LE(stability->slide, 1.0);
  }
}

TEST(Stability, PoseWithoutContactIsNotProbedAndNoSureJoin) {
  const Pair pair = make_pair(5);
  const Joint joint(pair.a, pair.b);
  const Rigid apart = Rigid{glm::dmat3(1.0), glm::dvec3(1000, 0, 0)} * pair.truth;
  EXPECT_FALSE(probe(joint, apart, joint.evidence(apart, 0)));
  EXPECT_EQ(verdict_of(1.0, std::nullopt), Verdict::Unsure);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20}), Verdict::Join);
}

TEST(Score, PoseThatAnotherComesNearOrThatTurnsIsNoSureJoin) {
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20, .repeat_deg = 0.5}), Verdict::Join);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 8, .repeat_deg = 0.5}), Verdict::Unsure);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20, .repeat_deg = 4}), Verdict::Unsure);
  EXPECT_EQ(verdict_of(0.1, Stability{.margin = 20, .repeat_deg = 0.5}), Verdict::NoJoin);
}

TEST(Score, GrowsWithStrengthBetweenZeroAndOne) {
  EXPECT_LT(score_of(-50.0), 0.01);
  EXPECT_GT(score_of(200.0), 0.99);
  for (double s = -20; s < 60; s += 1) EXPECT_LE(score_of(s), score_of(s + 1));
}

}  // namespace
}  // namespace rejoin::match
