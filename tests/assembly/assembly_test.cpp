/// Joins that are true, false or unsure, of broken balls.
#include "assembly/assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "assembly/evidence.hpp"
#include "assembly/witness.hpp"
#include "broken_balls.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "match/align.hpp"

namespace rejoin::assembly::testing {
namespace {

TEST(Assemble, TrueJoinsPutEveryPieceWhereItBelongs) {
  const Result result = run(ball(), ball().all_true(0.99));
  EXPECT_EQ(groups_of(result), std::set<int>{0});
  EXPECT_LT(ball().worst_turn(result),
            0.5);  // the alignment may move pieces by a fraction of the grid's spacing
  EXPECT_GE(result.joins.size(), ball().fragments.size() - 1);
  for (const Placement& p : result.placements) EXPECT_GT(p.confidence, 0.98);
}

TEST(Assemble, AJoinThatPutsPiecesIntoEachOtherIsRejectedWithTheReason) {
  const Corner corner = corner_of(ball());
  const Result result = run(ball(), {ball().inside_link(corner.a, corner.b, 0.999)});
  EXPECT_EQ(result.groups, 0);
  EXPECT_TRUE(result.joins.empty());
  EXPECT_NE(result.placements[corner.b].reason.find("into each other"), std::string::npos)
      << result.placements[corner.b].reason;
  EXPECT_NE(result.placements[corner.c].reason.find("no pose was found"), std::string::npos);
}

TEST(SamePose, IsAskedOfTheSmallerPiece) {
  mesh::Mesh small = ball().fragments[1].surface;
  for (glm::vec3& v : small.vertices) v *= 0.1F;
  const match::Fragment chip = match::prepare("chip", small, Context());
  const Piece large(ball().fragments[0]);
  const Piece little(chip);
  const Options options;
  const auto shifted = [&](double share) {
    return Rigid{glm::dmat3(1.0), {share * options.same_shift * chip.diameter, 0, 0}};
  };
  ASSERT_GT(ball().fragments[0].diameter, 5.0 * chip.diameter);
  EXPECT_TRUE(same_pose(large, little, Rigid{}, shifted(0.9), options));
  EXPECT_FALSE(same_pose(large, little, Rigid{}, shifted(1.1), options));
  EXPECT_FALSE(same_pose(little, large, Rigid{}, shifted(1.1), options));
}

/// A piece scanned a second time: other vertices on the same surface, lying elsewhere.
mesh::Mesh scanned_again(mesh::Mesh scan, const Rigid& motion) {
  Random random(5);
  const double noise = 0.1 * mesh::resolution(scan);
  for (glm::vec3& v : scan.vertices) {
    const glm::dvec3 off(random.normal(), random.normal(), random.normal());
    v = glm::vec3(motion.rotation * (glm::dvec3(v) + noise * off));
  }
  scan.origin = motion(scan.origin);
  return scan;
}

TEST(Assemble, OfTwoScansOfOnePieceOneIsPlacedAndTheOtherToldToLieInIt) {
  const Rigid motion{axis_rotation({0, 0, 1}, 0.8), {30, -7, 2}};
  for (const bool other_hand : {false, true}) {
    Box box = ball();
    const std::size_t piece = corner_of(box).a;
    const std::size_t again = box.fragments.size();
    const Rigid moved = other_hand ? motion : Rigid{};
    const mesh::Mesh scan = box.fragments[piece].surface;
    box.fragments.push_back(
        match::prepare("again", other_hand ? scanned_again(scan, moved) : scan, Context()));
    box.to_world.push_back(box.to_world[piece] * inverse(moved));
    std::vector<Link> links = box.all_true(0.999);
    for (const shatter::Contact& c : box.contacts) {
      if (c.a == piece || c.b == piece) links.push_back(box.true_link(c.a + c.b - piece, again, 0.998));
    }
    const Result result = run(box, links);
    const bool first = result.placements[piece].group >= 0;
    EXPECT_NE(first, result.placements[again].group >= 0) << "other hand: " << other_hand;
    const std::string& reason = result.placements[first ? again : piece].reason;
    EXPECT_NE(reason.find("into each other"), std::string::npos) << reason;
    EXPECT_LT(box.worst_turn(result), 0.5);
    EXPECT_EQ(std::count_if(result.placements.begin(), result.placements.end(),
                            [](const Placement& p) { return p.group == 0; }),
              static_cast<std::ptrdiff_t>(ball().fragments.size()));
  }
}

TEST(Assemble, SecondScansOfTwoPiecesMakeAnObjectOfTheirOwnWhichIsTold) {
  Box box = ball();
  const Corner corner = corner_of(box);
  const std::size_t again = box.fragments.size();
  for (const std::size_t piece : {corner.a, corner.b}) {
    const mesh::Mesh scan = box.fragments[piece].surface;
    box.fragments.push_back(match::prepare("again", scanned_again(scan, Rigid{}), Context()));
    box.to_world.push_back(box.to_world[piece]);
  }
  std::vector<Link> links = box.all_true(0.9999);
  links.push_back(box.true_link(again, again + 1, 0.999));
  EXPECT_TRUE(run(box, links).doubts.empty()) << "nothing says whose scans they are";
  links.push_back(box.true_link(corner.c, again, 0.995));
  links.push_back(box.true_link(corner.c, again + 1, 0.994));
  const Result result = run(box, links);
  ASSERT_EQ(result.groups, 2);
  EXPECT_EQ(result.placements[again].group, 1);
  ASSERT_EQ(result.doubts.size(), 1U) << "one for two objects, however many joins there are between them";
  EXPECT_NE(result.doubts.front().find("two scans of one piece"), std::string::npos) << result.doubts.front();
  Options options;
  options.constraints.must_join = {{again, again + 1}};
  const std::string doubt = run(box, links, options).doubts.front();
  const std::string asked =
      "do {" + std::to_string(again) + "} and {" + std::to_string(again + 1) + "} join, as you said?";
  EXPECT_NE(doubt.find(asked), std::string::npos) << doubt;
}

TEST(Assemble, AFalseJoinGivesWayToTheLoopsThatContradictIt) {
  const Corner corner = corner_of(ball());
  std::vector<Link> links = ball().all_true(0.995);
  const std::size_t others = ball().contacts.size() - 1;
  ASSERT_GE(others, 4U);
  links.push_back(ball().false_link(corner.a, corner.b, 0.9999, 25.0, 0.3));  // surer than any true one
  const Result result = run(ball(), links);
  EXPECT_EQ(groups_of(result), std::set<int>{0});
  EXPECT_LT(ball().worst_turn(result), 0.5);
}

TEST(Assemble, AnUnsureJoinIsNotUsedAlone) {
  const Corner corner = corner_of(ball());
  const Result result = run(ball(), {ball().true_link(corner.a, corner.b, 0.7)});
  EXPECT_EQ(result.groups, 0);
  EXPECT_NE(result.placements[corner.a].reason.find("no join is sure"), std::string::npos);
}

TEST(Assemble, AnImpossibleJoinIsNotOfferedAsTheBest) {
  const Corner corner = corner_of(ball());
  const Result result = run(ball(), {ball().true_link(corner.a, corner.b, 0.001)});
  EXPECT_EQ(result.placements[corner.a].reason,
            "nothing fits it: its best score with another fragment is 0.001");
}

TEST(Assemble, AJoinOfHighScoreThatDoesNotHoldNeedsAWitness) {
  const Corner corner = corner_of(ball());
  std::vector<Link> links{ball().true_link(corner.a, corner.b, 0.9999)};
  EXPECT_EQ(run(ball(), links).groups, 1);
  links.front().holds = false;
  const Result alone = run(ball(), links);
  EXPECT_EQ(alone.groups, 0);
  EXPECT_NE(alone.placements[corner.a].reason.find("another pose of the two comes near"), std::string::npos);
  links.push_back(ball().true_link(corner.b, corner.c, 0.9999));
  links.push_back(ball().true_link(corner.c, corner.a, 0.7));
  const Result held = run(ball(), links);
  EXPECT_EQ(held.placements[corner.a].group, 0);
  EXPECT_LT(ball().worst_turn(held), 0.5);
}

// As patterns repeat: two pairs bear out one place, and the same two another one as well.
TEST(Assemble, OfTwoPlacesThatNeighboursBearOutAlikeNoneIsSure) {
  const Corner corner = corner_of(ball());
  const auto away = [&](std::size_t from, double shift, double score) {
    const glm::dmat3 turn = axis_rotation(glm::normalize(glm::dvec3(1, 2, 3)), shift);
    const Rigid place{turn, shift * 10.0 * ball().to_world[corner.c].translation /
                                glm::length(ball().to_world[corner.c].translation)};
    return Link{from, corner.c, inverse(ball().to_world[from]) * place * ball().to_world[corner.c], score};
  };
  std::vector<Link> links{ball().true_link(corner.a, corner.b, 0.9999), away(corner.a, 2.0, 0.97),
                          away(corner.b, 2.0, 0.97)};
  ASSERT_EQ(run(ball(), links).placements[corner.c].group, 0) << "no place else is known";
  links.push_back(away(corner.a, 3.0, 0.97));
  links.push_back(away(corner.b, 3.0, 0.97));
  const Result result = run(ball(), links);
  EXPECT_EQ(result.placements[corner.a].group, 0);
  EXPECT_EQ(result.placements[corner.c].group, -1);
}

TEST(Assemble, UnsureJoinsThatCloseALoopAreUsed) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> loop{ball().true_link(corner.a, corner.b, 0.7),
                               ball().true_link(corner.b, corner.c, 0.7),
                               ball().true_link(corner.c, corner.a, 0.7)};
  const Result result = run(ball(), loop);
  EXPECT_EQ(result.groups, 1);
  for (const std::size_t piece : {corner.a, corner.b, corner.c}) EXPECT_EQ(result.placements[piece].group, 0);
  EXPECT_LT(ball().worst_turn(result), 0.5);
}

TEST(Assemble, UnsureJoinsThatCloseNoLoopAreNot) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> open{ball().true_link(corner.a, corner.b, 0.7),
                               ball().false_link(corner.b, corner.c, 0.7, 40.0, 0.3),
                               ball().false_link(corner.c, corner.a, 0.7, 20.0, 0.2)};
  EXPECT_EQ(run(ball(), open).groups, 0);
}

TEST(Assemble, UnsureJoinsInARowAreNoWitnessesOfEachOther) {
  const Corner row = row_of(ball());
  ASSERT_NE(row.a, row.c);
  std::vector<Link> two{ball().true_link(row.a, row.b, 0.985), ball().true_link(row.b, row.c, 0.985)};
  EXPECT_EQ(run(ball(), two).groups, 0);
  for (Link& link : two) {
    link.score = 0.99999;
    link.holds = false;
  }
  EXPECT_EQ(run(ball(), two).groups, 0);
}

// What follows from two unsure joins was neither searched nor probed.
TEST(Assemble, APoseThatFollowsFromTwoOthersIsNotUsedAlone) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> two{ball().true_link(corner.a, corner.b, 0.7),
                              ball().true_link(corner.b, corner.c, 0.7)};
  Options options;
  options.constraints.must_not_join = {{corner.a, corner.b}};
  const Result result = run(ball(), two, options);
  EXPECT_EQ(result.placements[corner.a].group, -1);
  EXPECT_EQ(result.placements[corner.c].group, -1);
}

TEST(Assemble, APoseThatOnePairsSearchMissedFollowsFromTwoOthers) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> two{ball().true_link(corner.a, corner.b, 0.7),
                              ball().true_link(corner.b, corner.c, 0.7)};
  const Result result = run(ball(), two);
  ASSERT_EQ(result.groups, 1);
  EXPECT_LT(ball().worst_turn(result), 0.5);
  EXPECT_EQ(result.joins.size(), 3U);
  EXPECT_EQ(
      std::count_if(result.joins.begin(), result.joins.end(), [](const Join& join) { return join.found; }),
      1);
}

TEST(Assemble, AnUnsureJoinIsUsedWhereAThirdPieceFitsThatNobodySearchedFor) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> links{ball().true_link(corner.a, corner.b, 0.999),
                                ball().true_link(corner.a, corner.c, 0.1)};
  const Result result = run(ball(), links);
  ASSERT_EQ(result.groups, 1);
  EXPECT_EQ(result.placements[corner.c].group, 0);
  EXPECT_GT(result.placements[corner.c].confidence, 0.98);
  EXPECT_LT(ball().worst_turn(result), 0.5);
  const auto heard = std::find_if(result.joins.begin(), result.joins.end(), [&](const Join& join) {
    return join.a == std::min(corner.b, corner.c) && join.b == std::max(corner.b, corner.c);
  });
  ASSERT_NE(heard, result.joins.end());
  EXPECT_TRUE(heard->found);
  EXPECT_GT(heard->score, 0.9) << "the contact says by itself that it is a join";
}

TEST(Assemble, AnUnsureJoinIsNotUsedWhereTheThirdPieceDoesNotFit) {
  const Corner corner = corner_of(ball());
  const std::vector<Link> links{ball().true_link(corner.a, corner.b, 0.999),
                                ball().false_link(corner.a, corner.c, 0.1, 20.0, 0.05)};
  const Result result = run(ball(), links);
  ASSERT_EQ(result.groups, 1);
  EXPECT_EQ(result.placements[corner.c].group, -1);
}

TEST(Assemble, TwoUnsureJoinsAreUsedWhereTheThirdPairFitsThatNobodySearchedFor) {
  const Corner corner = corner_of(ball());
  const Link one = ball().true_link(corner.a, corner.b, 0.1);
  const Result result = run(ball(), {one, ball().true_link(corner.b, corner.c, 0.05)});
  ASSERT_EQ(result.groups, 1);
  for (const std::size_t piece : {corner.a, corner.b, corner.c}) {
    EXPECT_EQ(result.placements[piece].group, 0);
    EXPECT_GT(result.placements[piece].confidence, 0.98);
  }
  EXPECT_LT(ball().worst_turn(result), 0.5);
  EXPECT_EQ(run(ball(), {one, ball().false_link(corner.b, corner.c, 0.1, 20.0, 0.05)}).groups, 0);
}

/// Three equal sectors of a ring with one bumpy break between them, so that any may follow any.
Box equal_sectors() {
  constexpr int kCells = 60;
  const auto bump = [](float r, float z) {
    return 0.6F * std::sin(1.3F * r + 0.7F * z) + 0.5F * std::cos(0.9F * z - 1.7F * r) +
           0.4F * std::sin(2.3F * z);
  };
  mesh::Mesh sector = mesh::test::box({1, 1, 1}, kCells);
  for (glm::vec3& p : sector.vertices) {
    p += 0.5F;  // the box lies about the origin
    const float r = 4.0F + 8.0F * p.x;
    const float z = 14.0F * p.z;
    const float around = 2.0F * std::numbers::pi_v<float> / 3.0F * p.y + bump(r, z) / r;
    p = {r * std::cos(around), r * std::sin(around), z};
  }
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.fragments.push_back(match::prepare("sector", sector, Context()));
    box.to_world.push_back({axis_rotation({0, 0, 1}, 120.0 * k * kDegree), {}});
  }
  return box;
}

// Where each is heard alone, the third contact bears out either order.
TEST(Assemble, OfTwoWaysToPutThreeTogetherThatFitAlikeNoneIsSure) {
  const Box box = equal_sectors();
  std::vector<Link> links{box.true_link(0, 1, 0.1), box.true_link(1, 2, 0.1)};
  ASSERT_EQ(run(box, links).groups, 1);
  const Rigid back = inverse(box.truth(0, 1));
  links.push_back({0, 1, back, 0.1});
  links.push_back({1, 2, back, 0.1});
  EXPECT_EQ(run(box, links).groups, 0);
}

TEST(Witness, OtherContactsSpeakForTrueLinksOnly) {
  const Corner corner = corner_of(ball());
  std::vector<Piece> pieces;
  for (const match::Fragment& fragment : ball().fragments) pieces.emplace_back(fragment);
  const auto heard = [&](const Link& link) {
    std::vector<Rigid> poses = ball().to_world;
    poses[link.b] = poses[link.a] * link.pose;
    return witness_odds(pieces, {link}, {{corner.a, corner.b}, {corner.c}}, poses, {});
  };
  EXPECT_GT(heard(ball().true_link(corner.a, corner.c, 0.5)).value_or(0.0), 6.0);
  EXPECT_LE(heard(ball().false_link(corner.a, corner.c, 0.5, 20.0, 0.05)).value_or(0.0), 0.0);
  EXPECT_FALSE(heard(ball().inside_link(corner.a, corner.c, 0.5)));
}

TEST(Witness, CloseContactSpeaksForAPoseAndLooseContactAgainst) {
  match::Evidence evidence;
  evidence.tolerance = 1.0;
  EXPECT_EQ(witness_odds(evidence, false), 0.0) << "nothing touches";
  evidence.shared_area = 10.0;
  evidence.patch_area = 2.5;
  evidence.contact_area = 9.5;
  const double close = witness_odds(evidence, false);
  EXPECT_GT(close, 1.0) << "flat surfaces without any shape to agree on";
  evidence.contact_area = 4.0;
  EXPECT_LT(witness_odds(evidence, false), -1.0);
  evidence.contact_area = 9.5;
  evidence.information = 3.0;
  EXPECT_GT(witness_odds(evidence, false), close + 1.0);
  EXPECT_GT(witness_odds(evidence, true), 1.0) << "shape counts in the plane of the link, too";
  evidence.information = 0.0;
  EXPECT_EQ(witness_odds(evidence, true), 0.0);
  evidence.penetration_area = 10.0;
  EXPECT_LT(witness_odds(evidence, false), 0.0) << "as much lies inside as touches";
}

TEST(Witness, FlatContactsSpeakOutOfTheLinksPlaneAlone) {
  const match::Fragment cube = match::prepare("cube", mesh::test::box({20, 20, 20}, 12), Context{});
  std::vector<Piece> pieces;
  std::vector<Rigid> poses;
  for (const glm::dvec3& at : {glm::dvec3(-10, -10, 0), {10, -10, 0}, {-10, 10, 0}, {10, 10, 0}}) {
    pieces.emplace_back(cube);
    poses.push_back({glm::dmat3(1.0), at});
  }
  const Link link{0, 2, inverse(poses[0]) * poses[2], 0.5};
  const auto heard = [&](const std::vector<std::vector<std::size_t>>& groups, bool slides = false) {
    Link asked = link;
    asked.slides = slides;
    return witness_odds(pieces, {asked}, groups, poses, {});
  };
  ASSERT_TRUE(heard({{0, 1}, {2, 3}}));
  EXPECT_GT(*heard({{0, 1}, {2, 3}}), 1.0) << "heard, by its outline";
  // 1 and 3 meet in the plane in which 0 and 2 do, 3 and 2 at a right angle to it: whole sides both.
  EXPECT_GT(heard({{0, 3}, {2}}).value_or(0.0), *heard({{0, 1}, {2, 3}}) + 5.0);
  EXPECT_LE(heard({{0, 3}, {2}}, true).value_or(1.0), 0.0) << "what slides comes to lie on others by itself";
}

// Two bricks side by side and one on both.
TEST(Assemble, JoinsAlongWhichPiecesSlideAreNoWitnessesOfEachOther) {
  const match::Fragment brick = match::prepare("brick", mesh::test::box({20, 20, 20}, 12), Context{});
  const std::vector<match::Fragment> bricks{brick, brick, brick};
  const std::array at{Rigid{glm::dmat3(1.0), {-10, 0, 0}}, Rigid{glm::dmat3(1.0), {10, 0, 0}},
                      Rigid{glm::dmat3(1.0), {0, 0, 20}}};
  const auto together = [&](bool slide) {
    std::vector<Link> links;
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 2)})
      links.push_back({static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                       inverse(at[static_cast<std::size_t>(a)]) * at[static_cast<std::size_t>(b)], 0.5, true,
                       slide});
    return assemble(bricks, links, {}, Context()).groups;
  };
  EXPECT_EQ(together(false), 1);
  EXPECT_EQ(together(true), 0);
}

TEST(Assemble, TwoObjectsStayTwo) {
  const Result result = run(two_balls(), two_balls().all_true(0.99));
  EXPECT_EQ(result.groups, 2);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(result.placements[k].group, k < 5 ? 0 : 1);
  for (const Join& join : result.joins) EXPECT_EQ(join.a < 5, join.b < 5);
}

TEST(Assemble, ContactWithoutACandidateIsListedAsFound) {
  std::vector<Link> links = ball().all_true(0.99);
  const auto largest = std::max_element(ball().contacts.begin(), ball().contacts.end(),
                                        [](const auto& x, const auto& y) { return x.area < y.area; });
  links.erase(links.begin() + (largest - ball().contacts.begin()));
  const Result result = run(ball(), links);
  const auto found = std::find_if(result.joins.begin(), result.joins.end(), [&](const Join& join) {
    return join.a == largest->a && join.b == largest->b;
  });
  ASSERT_NE(found, result.joins.end());
  EXPECT_TRUE(found->found);
  EXPECT_GT(found->contact_area, 0.3 * largest->area);  // worn edges and steep places do not count
}

TEST(Assemble, FiguresOfAJoinAreThoseOfItsMatch) {
  const Result result = run(ball(), ball().all_true(0.99));
  ASSERT_FALSE(result.joins.empty());
  for (const Join& join : result.joins) {
    const match::Fragment& a = ball().fragments[join.a];
    const match::Fragment& b = ball().fragments[join.b];
    const Rigid pose = inverse(result.placements[join.a].pose) * result.placements[join.b].pose;
    const match::Evidence evidence = match::Joint(a, b).evidence(match::to_origins(a, b, pose), 0);
    // One computes in single precision: a sample in a hundred may cross a limit.
    EXPECT_NEAR(join.contact_area, evidence.contact_area, 0.01 * evidence.contact_area);
    EXPECT_NEAR(join.gap_median, evidence.gap_median, 0.01 * evidence.gap_median);
  }
}

TEST(Assemble, AlignmentTogetherMendsJoinsThatAreALittleOff) {
  std::vector<Link> links;
  for (const auto& c : ball().contacts) links.push_back(ball().false_link(c.a, c.b, 0.99, 1.5, 0.01));
  EXPECT_LT(ball().worst_turn(run(ball(), links)), 0.75);
}

// The two pieces that touch least, whose only candidate is false: put first, it would break the ball apart.
TEST(Assemble, SameResultForAnyNumberOfThreadsAndOrderOfLinks) {
  std::vector<Link> links = two_balls().all_true(0.9);
  for (std::size_t k = 0; k < links.size(); ++k) links[k].score += 0.005 * static_cast<double>(k + 1);
  const Result many = run(two_balls(), links);
  std::reverse(links.begin(), links.end());
  const ThreadLimit one(1);
  const Result single = run(two_balls(), links);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(many.placements[k].pose.translation, single.placements[k].pose.translation);
    EXPECT_EQ(many.placements[k].pose.rotation, single.placements[k].pose.rotation);
  }
}

TEST(Assemble, NoFragmentsAndNoLinksAreNothing) {
  EXPECT_TRUE(assemble({}, {}, {}, Context()).placements.empty());
  EXPECT_EQ(run(ball(), {}).groups, 0);
}

TEST(Assemble, EndsWhenCancelled) {
  Context context;
  context.cancel();
  EXPECT_TRUE(assemble(ball().fragments, ball().all_true(0.99), {}, context).cancelled);
}

}  // namespace
}  // namespace rejoin::assembly::testing
