/// Broken balls with known poses, and joins that are true, false or unsure.
#include "assembly/assembly.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "../mesh/shapes.hpp"
#include "assembly/witness.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "match/align.hpp"
#include "shatter/shatter.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kDegree = 0.017453292519943295;

/// The pieces of one or more balls; made once for all tests.
struct Box {
  std::vector<match::Fragment> fragments;
  std::vector<Rigid> to_world;
  std::vector<shatter::Contact> contacts;

  void add_ball(float radius, std::uint64_t seed, int pieces) {
    shatter::Options options;
    options.pieces = pieces;
    options.seed = seed;
    options.spacing = 0.03;
    options.roughness = 2.0;
    options.chips = 0.0;
    const shatter::Shattered ball =
        shatter::shatter("ball", mesh::test::icosphere(radius, 4), options, Context());
    const std::size_t first = fragments.size();
    for (const shatter::Piece& piece : ball.pieces) {
      fragments.push_back(match::prepare("piece", piece.scan, Context()));
      to_world.push_back(piece.to_world);
    }
    for (const shatter::Contact& c : ball.contacts) contacts.push_back({first + c.a, first + c.b, c.area});
  }

  Rigid truth(std::size_t a, std::size_t b) const { return inverse(to_world[a]) * to_world[b]; }

  Link true_link(std::size_t a, std::size_t b, double score) const { return {a, b, truth(a, b), score}; }

  std::vector<Link> all_true(double score) const {
    std::vector<Link> links;
    links.reserve(contacts.size());
    for (const shatter::Contact& c : contacts) links.push_back(true_link(c.a, c.b, score));
    return links;
  }

  /// b turned and shifted against where it belongs, in a's axes about the middle of b.
  Link false_link(std::size_t a, std::size_t b, double score, double turn_deg, double shift) const {
    const glm::dvec3 centre = mesh::centroid(fragments[b].surface) + fragments[b].surface.origin;
    const glm::dvec3 at = truth(a, b)(centre);
    const glm::dmat3 turn = axis_rotation(glm::normalize(glm::dvec3(1, 2, 3)), turn_deg * kDegree);
    const glm::dvec3 push = shift * fragments[b].diameter * glm::normalize(glm::dvec3(3, -1, 1));
    return {a, b, Rigid{turn, at + push - turn * at} * truth(a, b), score};
  }

  /// b's middle put on a's.
  Link inside_link(std::size_t a, std::size_t b, double score) const {
    const auto middle = [&](std::size_t k) {
      return mesh::centroid(fragments[k].surface) + fragments[k].surface.origin;
    };
    return {a, b, Rigid{glm::dmat3(1.0), middle(a) - middle(b)}, score};
  }

  /// Largest angle, degrees, by which two pieces of a group lie wrong to each other.
  double worst_turn(const Result& result) const {
    double worst = 0.0;
    for (std::size_t a = 0; a < fragments.size(); ++a) {
      for (std::size_t b = a + 1; b < fragments.size(); ++b) {
        const Placement& x = result.placements[a];
        const Placement& y = result.placements[b];
        if (x.group < 0 || x.group != y.group) continue;
        worst = std::max(worst, angle_between(inverse(x.pose) * y.pose, truth(a, b)) / kDegree);
      }
    }
    return worst;
  }
};

const Box& ball() {
  static const Box box = [] {
    Box made;
    made.add_ball(10.0F, 3, 5);
    return made;
  }();
  return box;
}

const Box& two_balls() {
  static const Box box = [] {
    Box made = ball();
    made.add_ball(7.0F, 8, 3);
    return made;
  }();
  return box;
}

Result run(const Box& box, const std::vector<Link>& links, const Options& options = {}) {
  return assemble(box.fragments, links, options, Context());
}

std::set<int> groups_of(const Result& result) {
  std::set<int> groups;
  for (const Placement& p : result.placements) groups.insert(p.group);
  return groups;
}

/// Two pieces that touch, and a third that touches both.
struct Corner {
  std::size_t a, b, c;
};

Corner corner_of(const Box& box) {
  const auto touch = [&](std::size_t x, std::size_t y) {
    return std::any_of(box.contacts.begin(), box.contacts.end(),
                       [&](const auto& c) { return c.a == std::min(x, y) && c.b == std::max(x, y); });
  };
  for (const auto& contact : box.contacts) {
    for (std::size_t c = 0; c < box.fragments.size(); ++c) {
      if (c != contact.a && c != contact.b && touch(contact.a, c) && touch(contact.b, c)) {
        return {contact.a, contact.b, c};
      }
    }
  }
  return {0, 0, 0};
}

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

TEST(Witness, OtherContactsSpeakForTrueLinksOnly) {
  const Corner corner = corner_of(ball());
  std::vector<Piece> pieces;
  for (const match::Fragment& fragment : ball().fragments) pieces.emplace_back(fragment);
  const auto heard = [&](const Link& link) {
    std::vector<Rigid> poses = ball().to_world;
    poses[link.b] = poses[link.a] * link.pose;
    return witness_odds(pieces, {link}, {{corner.a, corner.b}, {corner.c}}, poses, {});
  };
  EXPECT_GT(heard(ball().true_link(corner.a, corner.c, 0.5)), 6.0);
  EXPECT_LE(heard(ball().false_link(corner.a, corner.c, 0.5, 20.0, 0.05)), 0.0);
  EXPECT_LE(heard(ball().inside_link(corner.a, corner.c, 0.5)), 0.0);
}

TEST(Witness, CloseContactSpeaksForAPoseAndLooseContactAgainst) {
  match::Evidence evidence;
  evidence.tolerance = 1.0;
  EXPECT_EQ(witness_odds(evidence), 0.0) << "nothing touches";
  evidence.shared_area = 10.0;
  evidence.patch_area = 2.5;
  evidence.contact_area = 9.5;
  const double close = witness_odds(evidence);
  EXPECT_GT(close, 1.0) << "flat surfaces without any shape to agree on";
  evidence.contact_area = 4.0;
  EXPECT_LT(witness_odds(evidence), -1.0);
  evidence.contact_area = 9.5;
  evidence.information = 3.0;
  EXPECT_GT(witness_odds(evidence), close + 1.0);
  evidence.information = 0.0;
  evidence.penetration_area = 10.0;
  EXPECT_LT(witness_odds(evidence), 0.0) << "as much lies inside as touches";
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

TEST(Constraints, PairsThatMustNotJoinStayApart) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_not_join = {{corner.a, corner.b}};
  const Result result = run(ball(), ball().all_true(0.99), options);
  const bool together = result.placements[corner.a].group >= 0 &&
                        result.placements[corner.a].group == result.placements[corner.b].group;
  EXPECT_FALSE(together);
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
  EXPECT_TRUE(result.warnings.empty());
}

// The two pieces that touch least, whose only candidate is false: put first, it would break the ball apart.
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

TEST(Constraints, AWishThatCannotBeKeptIsSaid) {
  const Corner corner = corner_of(ball());
  Options options;
  options.constraints.must_join = {{corner.a, corner.b}};
  EXPECT_EQ(run(ball(), {}, options).warnings.size(), 1U);
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
            std::vector<std::string>{other_way + " must not join, but touch at the poses given"});
  const Rigid inside = at_a * ball().inside_link(corner.a, corner.b, 1.0).pose;
  EXPECT_EQ(warnings(inside, false),
            std::vector<std::string>{"the poses given put " + other_way + " into each other"});
}

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
}  // namespace rejoin::assembly
