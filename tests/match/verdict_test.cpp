#include "match/verify.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/random.hpp"
#include "match/refine.hpp"
#include "match/stability.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::flat_half;
using testing::grooved_half;
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

// Along a break's width, where it is shorter; its length is held by the relief.
TEST(Stability, PushesWhereTheJointHoldsLeast) {
  const Fragment below = grooved_half(true);
  const Fragment above = grooved_half(false);
  const Joint joint(below, above);
  EXPECT_GT(std::abs(joint.least_held(Rigid{}, joint.tolerance()).y), 0.99);
  EXPECT_GT(slide_at(joint, Rigid{}), 0.8);
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
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20, .next_share = 0.5}), Verdict::Join);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20, .next_share = 0.9}), Verdict::Unsure);
  EXPECT_EQ(verdict_of(0.1, Stability{.margin = 20, .repeat_deg = 0.5}), Verdict::NoJoin);
}

TEST(Score, GrowsWithStrengthBetweenZeroAndOne) {
  EXPECT_LT(score_of(-50.0), 0.01);
  EXPECT_GT(score_of(200.0), 0.99);
  for (double s = -20; s < 60; s += 1) EXPECT_LE(score_of(s), score_of(s + 1));
}

/// Strong, and with nothing against it.
Evidence sound() {
  Evidence evidence;
  evidence.contact_area = evidence.shared_area = 100.0;
  evidence.information = 50.0;
  evidence.tolerance = 0.2;
  return evidence;
}

bool tells(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(Against, NamesWhatTakesMostFromAJoint) {
  Evidence open = sound();
  open.shared_area = 200.0;
  open.wall_share = 0.7;
  EXPECT_TRUE(tells(objection(open), "50 % touches")) << objection(open);
  Evidence inside = sound();
  inside.penetration_area = 60.0;
  EXPECT_TRUE(tells(objection(inside), "lies inside")) << objection(inside);
  Evidence stepped = sound();
  stepped.wall_share = 0.3;
  EXPECT_TRUE(tells(objection(stepped), "only 30 % go on")) << objection(stepped);
  Evidence loose = sound();
  loose.gap_spread = 0.15;
  EXPECT_TRUE(tells(objection(loose), "gap varies by 0.15")) << objection(loose);
  EXPECT_EQ(objection(sound()), "");
}

// Where A is laid beside B, a part of it lies beyond B's view.
TEST(Figures, OverlapIsAShareOfTheWholeSilhouette) {
  const Fragment below = flat_half(true);
  const Fragment above = flat_half(false);
  Evidence flat = sound();
  flat.normal = {0, 0, 1};
  Verifier verifier(below, above, Options{});
  for (const double part : {0.25, 0.5, 1.0}) {
    const Rigid beside{glm::dmat3(1.0), glm::dvec3(2.0 * testing::kHalfX * (1.0 - part), 0, 0)};
    EXPECT_NEAR(verifier.candidate(beside, flat, 0.0).error.overlap, part, 0.03);  // two pixels
  }
}

// Where hardly anything touches, a volume over the contact alone would be many times the piece.
TEST(Figures, PenetrationIsNoDeeperThanWhatLiesInside) {
  const Pair pair = make_pair(5);
  Evidence inside = sound();
  inside.penetration = 2.0;
  inside.penetration_area = 50.0;
  EXPECT_DOUBLE_EQ(unmeasured(pair.a, pair.b, Rigid{}, inside, 0.0).error.penetration, 1.0);
  inside.contact_area = 0.01;
  EXPECT_DOUBLE_EQ(unmeasured(pair.a, pair.b, Rigid{}, inside, 0.0).error.penetration, 2.0);
}

TEST(Against, TellsWhatKeepsAHighScoreFromBeingAJoin) {
  Stability stability;
  stability.margin = 20.0;
  EXPECT_EQ(against(sound(), 1.0, stability), "");
  stability.margin = 1.0;
  EXPECT_TRUE(tells(against(sound(), 1.0, stability), "another pose"));
  stability.margin = 20.0;
  stability.repeat_deg = 30.0;
  EXPECT_TRUE(tells(against(sound(), 1.0, stability), "30.0 degrees"));
  stability.repeat_deg = 0.5;
  for (const auto& [doubt, words] : {std::pair{Doubt::Walls, "walls"},
                                     {Doubt::Loose, "does not touch"},
                                     {Doubt::Faint, "hardly any shape"},
                                     {Doubt::Drift, "drifts"},
                                     {Doubt::Slide, "slides"}}) {
    const Evidence held = at_most_even(sound(), doubt);
    EXPECT_TRUE(tells(against(held, score_of(strength(held)), stability), words)) << words;
  }
  EXPECT_TRUE(tells(against(sound(), 0.1, stability), "too little shape"));
  EXPECT_TRUE(tells(against(sound(), 0.98, stability), "shape in common, but too little to be sure"));
}

}  // namespace
}  // namespace rejoin::match
