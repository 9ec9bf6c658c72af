/// What the user asks of an assembly, on broken balls.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/piece.hpp"
#include "broken_balls.hpp"

namespace rejoin::assembly::testing {
namespace {

/// Whether two pieces are of two objects or do not touch in theirs.
bool apart(const Result& result, std::size_t a, std::size_t b) {
  if (result.placements[a].group < 0 || result.placements[a].group != result.placements[b].group) return true;
  return !touch_forbidden(Piece(ball().fragments[a]), Piece(ball().fragments[b]),
                          inverse(result.placements[a].pose) * result.placements[b].pose);
}

TEST(Constraints, PairsThatMustNotJoinStayApart) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_not_join = {{corner.a, corner.b}};
  const Result result = run(ball(), ball().all_true(0.99), options);
  const bool together = result.placements[corner.a].group >= 0 &&
                        result.placements[corner.a].group == result.placements[corner.b].group;
  EXPECT_FALSE(together);
}

/// Middle of a piece's surface where it belongs.
glm::dvec3 middle_of(std::size_t piece) {
  const mesh::Mesh& surface = ball().fragments[piece].surface;
  return ball().to_world[piece](mesh::centroid(surface) + surface.origin);
}

TEST(Constraints, PairsThatMustNotJoinAreNotPulledTogetherWhereJoinsAreALittleOff) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_not_join = {{corner.a, corner.c}};
  const glm::dvec3 away = glm::normalize(middle_of(corner.c) - middle_of(corner.a));
  Link off = ball().true_link(corner.b, corner.c, 0.995);
  off.pose.translation +=
      0.02 * ball().fragments[corner.c].diameter * (inverse(ball().to_world[corner.b]).rotation * away);
  EXPECT_TRUE(
      apart(run(ball(), {ball().true_link(corner.a, corner.b, 0.995), off}, options), corner.a, corner.c));
}

TEST(Constraints, PairsThatMustNotJoinAndTouchAtGivenPosesAreTold) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_not_join = {{corner.a, corner.c}};
  options.constraints.pinned = {{corner.a, ball().to_world[corner.a]}, {corner.c, ball().to_world[corner.c]}};
  const Result result = run(ball(), ball().all_true(0.99), options);
  EXPECT_FALSE(apart(result, corner.a, corner.c));
  EXPECT_EQ(result.warnings.size(), 1U);
}

TEST(Constraints, GivenPosesThatLetPiecesCrossALittleAreTold) {
  const Corner corner = corner_of(ball());
  Rigid deeper = ball().to_world[corner.b];
  deeper.translation +=
      0.06 * ball().fragments[corner.b].diameter * glm::normalize(middle_of(corner.a) - middle_of(corner.b));
  const auto warnings = [&](const Rigid& at_b) {
    Options options;
    options.constraints.pinned = {{corner.a, ball().to_world[corner.a]}, {corner.b, at_b}};
    return run(ball(), {}, options).warnings.size();
  };
  EXPECT_EQ(warnings(ball().to_world[corner.b]), 0U);
  EXPECT_EQ(warnings(deeper), 1U);
  EXPECT_FALSE(interpenetrate(Piece(ball().fragments[corner.a]), Piece(ball().fragments[corner.b]),
                              inverse(ball().to_world[corner.a]) * deeper))
      << "a searched pose may be off by that";
}

TEST(Constraints, APieceLeftOutByThemSaysSo) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_not_join = {{corner.b, corner.a}};
  const Result result = run(ball(), {ball().true_link(corner.a, corner.b, 0.99)}, options);
  EXPECT_NE(result.placements[corner.a].reason.find("must not be"), std::string::npos)
      << result.placements[corner.a].reason;
}

TEST(Constraints, TwoUnsureJoinsThatMakeAForbiddenPairTouchAreBothLeftOut) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> two{ball().true_link(corner.a, corner.b, 0.1),
                              ball().true_link(corner.b, corner.c, 0.05)};
  Options options;
  ASSERT_EQ(run(ball(), two, options).groups, 1);
  options.constraints.must_not_join = {{corner.a, corner.c}};
  EXPECT_EQ(run(ball(), two, options).groups, 0);
}

TEST(Constraints, PairsThatMustJoinDoSoHoweverLowTheScore) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_join = {{corner.a, corner.b}};
  const std::vector<Link> weak{ball().inside_link(corner.a, corner.b, 0.02),
                               ball().true_link(corner.a, corner.b, 0.01)};
  const Result result = run(ball(), weak, options);
  EXPECT_EQ(result.groups, 1);  // the better-scored pose overlaps, so the other is taken
  EXPECT_LT(ball().worst_turn(result), 0.5);
  EXPECT_EQ(result.warnings, std::vector<std::string>{
                                 fmt::format("{0} join at a pose of score 0.010, as at their best (0.020) "
                                             "{0} would lie in each other",
                                             fmt::format("{{{}}} and {{{}}}", corner.a, corner.b))});
}

// Where a false join held b by d, c lay in a; with b at its own place, what was heard there holds no longer.
TEST(Constraints, WhatFitsOnceAPairMustJoinIsAskedAnew) {
  const Box& box = ball();
  const Corner corner = corner_of(box);
  std::size_t d = 0;
  while (d < box.fragments.size() &&
         (d == corner.a || d == corner.b || d == corner.c || !box.touch(corner.a, d)))
    ++d;
  ASSERT_LT(d, box.fragments.size());
  const std::vector<Link> links{
      box.true_link(corner.a, d, 0.9999999), box.false_link(d, corner.b, 0.997, 0.0, 2.0),
      box.true_link(corner.a, corner.b, 0.2), box.true_link(corner.b, corner.c, 0.5)};
  Options options;
  options.constraints.must_join = {{corner.a, corner.b}};
  const Result result = run(box, links, options);
  for (const std::size_t piece : {corner.a, corner.b, corner.c, d})
    EXPECT_GE(result.placements[piece].group, 0) << piece;
  EXPECT_LT(box.worst_turn(result), 1.0);
}

TEST(Constraints, CancelledOverAWishKeepsWhatWasPutTogetherWithoutIt) {
  const Box& box = ball();
  const Corner row = row_of(box);
  std::vector<Link> links = box.all_true(0.999);
  links.push_back(box.false_link(row.a, row.c, 0.2, 0.0, 2.0));
  Options options;
  options.constraints.must_join = {{row.a, row.c}};
  Context* context = nullptr;
  int growths = 0;
  double last = 1.0;
  Context stopped([&](std::string_view stage, double part) {
    if (stage != "grow") return;
    if (part < last) ++growths;
    last = part;
    if (growths == 2) context->cancel();
  });
  context = &stopped;
  const Result result = assemble(box.fragments, links, options, stopped);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(groups_of(result), std::set<int>{0});
}

TEST(Constraints, PairsThatMustJoinAndDoAnyhowTakeNoOtherPose) {
  const auto least = std::min_element(ball().contacts.begin(), ball().contacts.end(),
                                      [](const auto& x, const auto& y) { return x.area < y.area; });
  std::vector<Link> links = ball().all_true(0.999);
  for (Link& link : links) {
    if (std::minmax(link.a, link.b) == std::minmax(least->a, least->b))
      link = ball().false_link(link.a, link.b, 0.01, 10.0, 1.5);
  }
  Options options;
  options.constraints.must_join = {{least->b, least->a}};
  const Result result = run(ball(), links, options);
  EXPECT_LT(ball().worst_turn(result), 0.5);
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_TRUE(std::any_of(result.joins.begin(), result.joins.end(), [&](const Join& join) {
    return std::minmax(join.a, join.b) == std::minmax(least->a, least->b);
  }));
}

TEST(Constraints, SureJoinsThatOtherWishesKeepAreNotToldAsLost) {
  const auto touch = [](std::size_t a, std::size_t b) {
    return std::ranges::any_of(ball().contacts,
                               [&](const auto& c) { return std::minmax(c.a, c.b) == std::minmax(a, b); });
  };
  std::vector<Link> links = ball().all_true(0.999);
  Options options;
  for (std::size_t a = 0; a < ball().fragments.size() && options.constraints.must_join.empty(); ++a) {
    for (std::size_t b = a + 1; b < ball().fragments.size(); ++b) {
      const std::size_t c = a == 0 ? (b == 1 ? 2 : 1) : 0;
      if (touch(a, b) || !touch(a, c) || !touch(b, c)) continue;
      links.push_back(ball().false_link(a, b, 0.01, 10.0, 1.5));
      options.constraints.must_join = {{a, b}, {a, c}, {b, c}};
      break;
    }
  }
  ASSERT_EQ(options.constraints.must_join.size(), 3U);
  const Result result = run(ball(), links, options);
  EXPECT_EQ(groups_of(result), std::set<int>{0});
  const auto [a, b] = options.constraints.must_join.front();
  EXPECT_EQ(result.warnings, std::vector<std::string>{fmt::format(
                                 "{{{}}} and {{{}}} must join, but at none of their poses they fit", a, b)});
}

TEST(Constraints, AWishThatCannotBeKeptIsSaid) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_join = {{corner.a, corner.b}};
  const std::string wish = fmt::format("{{{}}} and {{{}}} must join, but ", corner.a, corner.b);
  const auto warnings = [&](const std::vector<Link>& links) { return run(ball(), links, options).warnings; };
  EXPECT_EQ(warnings({ball().inside_link(corner.a, corner.b, 0.9)}),
            std::vector<std::string>{wish + "at none of their poses they fit"});
  EXPECT_EQ(warnings({}), std::vector<std::string>{wish + "no pose of the two is known"});
  options.without_pose[std::minmax(corner.a, corner.b)] = "they were never looked at";
  EXPECT_EQ(warnings({}),
            std::vector<std::string>{wish + "no pose of the two is known: they were never looked at"});
}

TEST(Constraints, PinnedPiecesStayWhereTheyAre) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.pinned = {{corner.a, ball().to_world[corner.a]}, {corner.c, ball().to_world[corner.c]}};
  const Result result = run(ball(), {ball().true_link(corner.a, corner.b, 0.99)}, options);
  EXPECT_EQ(result.placements[corner.a].pose.translation, ball().to_world[corner.a].translation);
  EXPECT_EQ(result.placements[corner.c].pose.rotation, ball().to_world[corner.c].rotation);
  EXPECT_LT(angle_between(result.placements[corner.b].pose, ball().to_world[corner.b]) / kDegree, 0.5);
  EXPECT_EQ(result.groups, 1);
}

TEST(Constraints, SureJoinsThatGivenPosesPartAreTold) {
  const Corner corner = corner_of(ball());
  Rigid away = ball().to_world[corner.b];
  away.translation += glm::dvec3(100.0, 0.0, 0.0);
  const auto warnings = [&](const Rigid& at_b, const std::vector<Link>& links) {
    Options options;
    options.constraints.pinned = {{corner.a, ball().to_world[corner.a]}, {corner.b, at_b}};
    return run(ball(), links, options).warnings;
  };
  const auto parted = [&](std::size_t x, std::size_t y) {
    return fmt::format("the poses given part {{{}}} and {{{}}} (score 0.995)", x, y);
  };
  const Link with_b = ball().true_link(corner.a, corner.b, 0.995);
  const Link with_c = ball().true_link(corner.a, corner.c, 0.999);
  const Link b_and_c = ball().true_link(corner.b, corner.c, 0.995);
  EXPECT_EQ(warnings(away, {with_b}), std::vector<std::string>{parted(corner.a, corner.b)});
  const std::vector<std::string> both = warnings(away, {with_c, b_and_c});
  EXPECT_NE(std::ranges::find(both, parted(corner.b, corner.c)), both.end())
      << "a piece without a given pose goes with the surer join";
  EXPECT_TRUE(warnings(ball().to_world[corner.b], {with_b, with_c, b_and_c}).empty());
  EXPECT_TRUE(warnings(ball().to_world[corner.b],
                       {with_b, with_c, ball().false_link(corner.b, corner.c, 0.995, 20.0, 1.5)})
                  .empty())
      << "joins contradict each other, whatever poses are given";
}

TEST(Constraints, OtherGroupsLieBesideThePinnedOne) {
  const Box& box = two_balls();
  const auto low_and_high = [&](const Result& result, std::size_t begin, std::size_t end) {
    double low = 1e300;
    double high = -1e300;
    for (std::size_t k = begin; k < end; ++k) {
      for (const glm::vec3& v : box.fragments[k].surface.vertices) {
        const double x = result.placements[k].pose(box.fragments[k].surface.origin + glm::dvec3(v)).x;
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    return std::pair(low, high);
  };
  Options options;
  options.constraints.pinned = {{0, box.to_world[0]}};  // in the first ball, around the frame's origin
  const Result result = run(box, box.all_true(0.999), options);
  ASSERT_EQ(result.groups, 2);
  EXPECT_GT(low_and_high(result, 5, 8).first, low_and_high(result, 0, 5).second);
}

TEST(Constraints, PosesGivenAgainstOtherWishesAreKeptAndTold) {
  const Corner corner = corner_of(ball());
  const Rigid at_a = ball().to_world[corner.a];
  const Rigid far_off{glm::dmat3(1.0), {100.0, 0.0, 0.0}};
  const auto warnings = [&](const Rigid& at_b, bool must) {
    Options options;
    options.constraints.pinned = {{corner.a, at_a}, {corner.b, at_b}};
    (must ? options.constraints.must_join : options.constraints.must_not_join) = {{corner.b, corner.a}};
    const Result result = run(ball(), {}, options);
    EXPECT_EQ(result.placements[corner.b].pose.translation, at_b.translation);
    return result.warnings;
  };
  const std::string names = fmt::format("{{{}}} and {{{}}}", corner.b, corner.a);
  const std::string other_way = fmt::format("{{{}}} and {{{}}}", corner.a, corner.b);
  EXPECT_TRUE(warnings(ball().to_world[corner.b], true).empty());
  EXPECT_EQ(warnings(far_off, true),
            std::vector<std::string>{names + " must join, but do not touch at the poses given"});
  EXPECT_TRUE(warnings(far_off, false).empty());
  EXPECT_EQ(warnings(ball().to_world[corner.b], false),
            std::vector<std::string>{names + " must not join, but touch at the poses given"});
  const Rigid inside = at_a * ball().inside_link(corner.a, corner.b, 1.0).pose;
  EXPECT_EQ(warnings(inside, false),
            std::vector<std::string>{"the poses given put " + other_way + " into each other"});
}

}  // namespace
}  // namespace rejoin::assembly::testing
