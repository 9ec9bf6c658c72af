#include "match/near.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../mesh/shapes.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::make_pair;
using testing::Pair;

/// A pose that is turned about B's centroid, and shifted.
Rigid off(const Pair& pair, double turn_deg, double shift) {
  const Rigid& truth = pair.planted.truth;
  const glm::dvec3 centre = truth(mesh::centroid(pair.b.surface) + pair.b.surface.origin);
  const glm::dmat3 turn = axis_rotation(glm::normalize(glm::dvec3(1, 2, -2)), turn_deg * kDegree);
  return Rigid{turn, centre - turn * centre + shift * glm::dvec3(0.6, 0.0, 0.8)} * truth;
}

TEST(Near, HoldsWhatIsTurnedAndShiftedByNoMoreThanItsLimits) {
  const Pair pair = make_pair(1);
  const Near near(pair.a, pair.b, pair.planted.truth);
  const double most = Near::kShift * std::min(pair.a.diameter, pair.b.diameter);
  const auto holds = [&](double turn_deg, double shift) {
    return near.holds(to_origins(pair.a, pair.b, off(pair, turn_deg, shift)));
  };
  EXPECT_TRUE(holds(0.99 * Near::kTurn_deg, 0.99 * most));
  EXPECT_FALSE(holds(1.01 * Near::kTurn_deg, 0));
  EXPECT_FALSE(holds(0, 1.01 * most));
}

TEST(Near, ThePlantedPoseIsFoundFromARoughOneWithLessWork) {
  const Pair pair = make_pair(1);
  const Result all = match(pair.a, pair.b, {}, Context{});
  Options options;
  options.near = off(pair, 15.0, 0.1 * pair.b.diameter);
  const Result result = match(pair.a, pair.b, options, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_LT(angle_between(result.candidates.front().pose, pair.planted.truth), 1.0 * kDegree);
  EXPECT_EQ(result.verdict, Verdict::Join);
  EXPECT_LT(result.evaluations, all.evaluations / 2);
}

Fragment box(const glm::vec3& size) {
  Fragment fragment;
  fragment.surface = mesh::test::box(size, 1);
  fragment.diameter = glm::length(size);
  return fragment;
}

TEST(Near, MayTouchWhateverATurnAndAShiftWithinTheLimitsMayBringTogether) {
  const Fragment block = box({100, 100, 100});
  const Fragment stick = box({1, 1, 100});
  // Upright on the block, then leaning as far as the limit allows, and lifted.
  const glm::dmat3 lean = axis_rotation({1, 0, 0}, Near::kTurn_deg * kDegree);
  const auto may = [&](double lifted) {
    return may_touch(block, stick, {lean, glm::dvec3(0, 0, 100.0 + lifted)});
  };
  const double most = Near::kShift * stick.diameter;
  EXPECT_TRUE(may(0.0));
  EXPECT_TRUE(may(0.99 * most)) << "down by the shift, and upright again";
  EXPECT_FALSE(may(most + 30.0)) << "its end swings by 22 at most";
}

TEST(Near, NoAnswerLiesFarFromARoughPoseThatIsWrong) {
  const Pair pair = make_pair(1);
  Options options;
  options.near = off(pair, 120.0, 0.0);
  const Near near(pair.a, pair.b, *options.near);
  const Result result = match(pair.a, pair.b, options, Context{});
  EXPECT_NE(result.verdict, Verdict::Join);
  for (const Candidate& candidate : result.candidates)
    EXPECT_TRUE(near.holds(to_origins(pair.a, pair.b, candidate.pose)));
}

// Nothing joins there, and what the search finds within the limits touches more.  The laid pose moves a little as it is aligned.
TEST(Near, TheLaidPoseIsAmongTheAnswersThoughOthersTouchMore) {
  const Pair pair = make_pair(1);
  for (const double turn : {120.0, 170.0}) {
    Options options;
    options.near = off(pair, turn, 0.0);
    const Result result = match(pair.a, pair.b, options, Context{});
    double least = 180.0;
    for (const Candidate& candidate : result.candidates)
      least = std::min(least, angle_between(candidate.pose, *options.near) / kDegree);
    EXPECT_LT(least, 5.0) << turn;
  }
}

}  // namespace
}  // namespace rejoin::match
