#include "outline/assembly.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "core/parallel.hpp"
#include "outline/detail/contour.hpp"
#include "outline/emd.hpp"
#include "outline/layout.hpp"
#include "outline/multiscale.hpp"
#include "outline/scan.hpp"
#include "outline/signal.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

Assembly assembled(const std::vector<Piece>& pieces, const Context& context = Context()) {
  const auto matcher = make_emd();
  matcher->prepare(pieces);
  return assemble(pieces, *matcher, {}, context);
}

TEST(Assembly, PutsABrokenBoardTogether) {
  const planted::Board board = planted::broken_board(3, 3, 0.05, 11);
  const Assembly assembly = assembled(board.pieces);
  EXPECT_TRUE(assembly.unplaced.empty());
  for (std::size_t i = 1; i < board.pieces.size(); ++i) {
    EXPECT_EQ(assembly.placements[i].group, 0U);
    // The noise is 0.05 and a border's points lie 1.6 apart.
    EXPECT_LT(misplaced(board, assembly, 0, i), 0.3) << "piece " << i;
  }
  for (const AssemblyJoin& join : assembly.joins) {
    const auto column = [](std::size_t i) { return static_cast<int>(i % 3); };
    const auto row = [](std::size_t i) { return static_cast<int>(i / 3); };
    EXPECT_EQ(std::abs(column(join.a) - column(join.b)) + std::abs(row(join.a) - row(join.b)), 1);
  }
  EXPECT_EQ(assembly.joins.size(), 12U);
}

TEST(Assembly, KeepsTwoObjectsAndAStrangerApart) {
  planted::Board all = planted::broken_board(2, 2, 0.05, 21);
  const planted::Board second = planted::broken_board(3, 1, 0.05, 22);
  const planted::Board stranger = planted::broken_board(2, 1, 0.05, 23);
  all.pieces.insert(all.pieces.end(), second.pieces.begin(), second.pieces.end());
  all.pieces.push_back(stranger.pieces[0]);
  const Assembly assembly = assembled(all.pieces);
  ASSERT_EQ(assembly.unplaced, std::vector<std::size_t>{7});
  for (const std::size_t i : {0U, 1U, 2U, 3U}) EXPECT_EQ(assembly.placements[i].group, 0U);
  for (const std::size_t i : {4U, 5U, 6U}) EXPECT_EQ(assembly.placements[i].group, 1U);
}

TEST(Assembly, IsTheSameForAnyNumberOfThreads) {
  const planted::Board board = planted::broken_board(2, 2, 0.1, 31);
  const Assembly many = assembled(board.pieces);
  const ThreadLimit limit(1);
  const Assembly one = assembled(board.pieces);
  ASSERT_EQ(many.joins.size(), one.joins.size());
  for (std::size_t i = 0; i < board.pieces.size(); ++i) {
    EXPECT_EQ(many.placements[i].pose.angle_rad, one.placements[i].pose.angle_rad);
    EXPECT_EQ(many.placements[i].pose.translation, one.placements[i].pose.translation);
  }
}

TEST(Assembly, RefusesAJoinThatMakesPiecesOverlap) {
  const planted::Board board = planted::broken_board(3, 1, 0.05, 41);
  // The middle piece laid on the left one, twice: where it belongs, and as a lie with a better score for the right one.
  const auto relative = [&](std::size_t a, std::size_t b) {
    return inverse(board.poses[a]) * board.poses[b];
  };
  std::vector<PairResult> pairs(3);
  JoinCandidate right;
  right.score = 0.9;
  right.pose = relative(0, 1);
  pairs[0].candidates = {right};
  JoinCandidate lie = right;
  lie.pose = relative(0, 1) * Planar{0.0, {5.0, 5.0}, false};
  pairs[1].candidates = {lie};
  right.pose = relative(1, 2);
  pairs[2].candidates = {right};
  const Assembly assembly = assemble(board.pieces, pairs, {}, Context());
  EXPECT_TRUE(assembly.unplaced.empty());
  EXPECT_LT(misplaced(board, assembly, 0, 2), 0.5);
}

TEST(Assembly, PiecesThatFitNeedTheSearchToSaySo) {
  const planted::Board board = planted::broken_board(2, 1, 0.05, 43);
  std::vector<PairResult> pairs(1);
  JoinCandidate candidate;
  candidate.pose = inverse(board.poses[0]) * board.poses[1];
  AssemblyOptions options;
  options.least_strength = 30.0;
  for (const auto& [score, unplaced] : {std::pair(0.1, 2U), std::pair(0.999999, 0U)}) {
    candidate.score = score;
    pairs[0].candidates = {candidate};
    EXPECT_EQ(assemble(board.pieces, pairs, options, Context()).unplaced.size(), unplaced) << score;
  }
}

TEST(Assembly, WeakCandidatesThatAgreeJoinAPieceThatOneAloneDoesNot) {
  const planted::Board board = planted::broken_board(2, 2, 0.05, 44);
  const auto candidate = [&](std::size_t a, std::size_t b, double score) {
    JoinCandidate join;
    join.pose = inverse(board.poses[a]) * board.poses[b];
    join.score = score;
    return PairResult{{join}};
  };
  std::vector<PairResult> pairs(6);  // (0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)
  AssemblyOptions options;
  options.least_strength = 20.0;
  pairs[0] = candidate(0, 1, 1.0);
  pairs[1] = candidate(0, 2, 1.0);
  pairs[4] = candidate(1, 3, 0.7);
  EXPECT_EQ(assemble(board.pieces, pairs, options, Context()).unplaced, std::vector<std::size_t>{3});
  pairs[5] = candidate(2, 3, 0.7);
  const Assembly assembly = assemble(board.pieces, pairs, options, Context());
  EXPECT_TRUE(assembly.unplaced.empty());
  EXPECT_LT(misplaced(board, assembly, 0, 3), 0.5);
}

// At most one of two places along one border is right.
TEST(Assembly, CandidatesOfOneBorderTakeFromEachOther) {
  const planted::Board board = planted::broken_board(2, 1, 0.05, 43);
  std::vector<PairResult> pairs(1);
  JoinCandidate candidate;
  candidate.pose = inverse(board.poses[0]) * board.poses[1];
  candidate.score = 0.95;
  candidate.boundary = {0.0, 0.0, 100.0, 0, 0};
  pairs[0].candidates = {candidate};
  AssemblyOptions options;
  options.least_strength = 16.0;
  ASSERT_TRUE(assemble(board.pieces, pairs, options, Context()).unplaced.empty());
  JoinCandidate beside = candidate;
  beside.pose = Planar{0.0, {30.0, 300.0}, false} * candidate.pose;
  pairs[0].candidates = {candidate, beside};
  EXPECT_EQ(assemble(board.pieces, pairs, options, Context()).unplaced.size(), 2U);
}

TEST(Assembly, GivesAJoinTheScoreOfItsPairAndAPieceTheChanceThatOneIsTrue) {
  const planted::Board board = planted::broken_board(2, 1, 0.05, 43);
  std::vector<PairResult> pairs(1);
  JoinCandidate candidate;
  candidate.pose = inverse(board.poses[0]) * board.poses[1];
  candidate.score = 0.8;
  JoinCandidate elsewhere;
  elsewhere.pose = Planar{1.0, {900.0, 40.0}, false} * candidate.pose;
  elsewhere.score = 0.9;
  pairs[0].candidates = {elsewhere, candidate};
  const Assembly assembly = assemble(board.pieces, pairs, {}, Context());
  ASSERT_EQ(assembly.joins.size(), 1U);
  EXPECT_DOUBLE_EQ(assembly.joins[0].score, 0.8);
  for (const Placement& placed : assembly.placements) EXPECT_NEAR(placed.confidence, 0.8, 1e-12);
}

// As of two sheets torn together.
TEST(Assembly, OfTwoPiecesThatFitOneBorderNeitherIsSure) {
  planted::Board board = planted::broken_board(2, 1, 0.05, 43);
  Piece twin = board.pieces[1];
  Random random(7);
  for (glm::dvec2& point : twin.outline.points) {  // the same break, but a shorter piece
    const glm::dvec2 p = board.poses[1](point);
    point = p.x < 150.0 ? p : glm::dvec2(150.0 + 0.6 * (p.x - 150.0), p.y);
  }
  board.pieces.push_back(planted::moved(twin, Planar{1.0, {30.0, 500.0}, false}, 0.05, random));
  const Assembly assembly = assembled(board.pieces);
  ASSERT_EQ(assembly.joins.size(), 1U);
  const AssemblyJoin& join = assembly.joins[0];
  EXPECT_EQ(join.a, 0U);
  ASSERT_EQ(join.rivals.size(), 1U);
  EXPECT_EQ(join.rivals[0].at, 0U);
  EXPECT_EQ(join.rivals[0].piece, 3U - join.b);
  EXPECT_GT(join.rivals[0].score, kSureScore);
  EXPECT_LT(join.score, kSureScore);
  EXPECT_EQ(assembly.unplaced, std::vector<std::size_t>{3U - join.b});

  board.pieces.pop_back();
  const Assembly alone = assembled(board.pieces);
  ASSERT_EQ(alone.joins.size(), 1U);
  EXPECT_TRUE(alone.joins[0].rivals.empty());
  EXPECT_GT(alone.joins[0].score, kSureScore);
}

/// A strip cut with scissors, as a scanner sees it.
Piece strip(double length, double angle_rad) {
  const glm::dvec2 along(std::cos(angle_rad), std::sin(angle_rad));
  const glm::dvec2 across(-along.y, along.x);
  const glm::dvec2 corner = glm::dvec2(320.0, 320.0) - 0.5 * length * along - 120.0 * across;
  const std::vector<glm::dvec2> border{corner, corner + length * along,
                                       corner + length * along + 240.0 * across, corner + 240.0 * across};
  std::vector<float> coverage = pixel_coverage(border, 640, 640);
  Piece piece;
  piece.name = "strip";
  piece.outline.points = detail::contours(cv::Mat(640, 640, CV_32F, coverage.data()), 0.5F, 12)[0];
  return piece;
}

// Borders of one slope have one staircase of pixels, which agrees very well and means nothing.
TEST(Assembly, StraightStripsOfOneSlopeAreNotPutTogether) {
  for (const double degrees : {3.0, 7.0, 12.0}) {
    const double angle = degrees * M_PI / 180.0;
    const std::vector<Piece> pieces{strip(450.0, angle), strip(400.0, angle + M_PI / 2), strip(480.0, angle)};
    const auto matcher = make_multiscale();
    matcher->prepare(pieces);
    const Assembly made = assemble(pieces, *matcher, {}, Context());
    EXPECT_EQ(made.unplaced.size(), 3U) << degrees;
  }
}

TEST(Assembly, AnObjectOfSecondScansIsTold) {
  planted::Board board = planted::broken_board(3, 3, 0.05, 12);
  Random random(9);
  for (const std::size_t k : {0U, 1U}) {
    const Planar turned{1.0, {900.0, 40.0 + 300.0 * k}, false};
    board.pieces.push_back(planted::moved(board.pieces[k], turned, 0.05, random));
  }
  const Assembly assembly = assembled(board.pieces);
  ASSERT_EQ(assembly.repeats.size(), 2U) << "placed by each other or not";
  std::set<std::set<std::size_t>> pairs;
  for (const AssemblyRepeat& repeat : assembly.repeats) {
    EXPECT_FALSE(repeat.turned_over);
    pairs.insert({repeat.piece, repeat.of});
  }
  EXPECT_EQ(pairs, (std::set<std::set<std::size_t>>{{0, 9}, {1, 10}}));
}

TEST(Assembly, ASecondScanOfAPieceIsNotLaidOnTheFirst) {
  planted::Board board = planted::broken_board(3, 3, 0.05, 12);
  const std::vector<AssemblyJoin> once = assembled(board.pieces).joins;
  Random random(9);
  board.pieces.push_back(planted::moved(board.pieces[4], {1.0, {900.0, 40.0}, false}, 0.05, random));
  const Assembly assembly = assembled(board.pieces);
  ASSERT_EQ(assembly.unplaced.size(), 1U);
  EXPECT_TRUE(assembly.unplaced[0] == 4 || assembly.unplaced[0] == 9) << assembly.unplaced[0];
  ASSERT_EQ(assembly.repeats.size(), 1U);
  EXPECT_EQ(assembly.repeats[0].piece, assembly.unplaced[0]);
  EXPECT_EQ(assembly.repeats[0].of, 13U - assembly.unplaced[0]);
  for (const AssemblyJoin& join : assembly.joins)
    for (const AssemblyRival& rival : join.rivals)
      EXPECT_NE(rival.piece, assembly.unplaced[0]) << "it asks for its own place";
  ASSERT_EQ(assembly.joins.size(), once.size());
  const auto total = [](const std::vector<AssemblyJoin>& joins) {
    double sum = 0.0;
    for (const AssemblyJoin& join : joins) sum += join.contact;
    return sum;
  };
  EXPECT_NEAR(total(assembly.joins), total(once), 0.01 * total(once));  // the scans' noise
}

TEST(Assembly, TellsOfAJoinThatNoPairWasFoundFor) {
  const planted::Board board = planted::broken_board(2, 2, 0.05, 43);
  // Pieces 0 and 1, 0 and 2, 1 and 3: nothing was found for 2 and 3, which lie side by side all the same.
  std::vector<PairResult> pairs(6);
  const auto known = [&](std::size_t pair, std::size_t a, std::size_t b) {
    JoinCandidate join;
    join.score = 0.9;
    join.pose = inverse(board.poses[a]) * board.poses[b];
    pairs[pair].candidates = {join};
  };
  known(0, 0, 1);
  known(1, 0, 2);
  known(4, 1, 3);
  const Assembly assembly = assemble(board.pieces, pairs, {}, Context());
  ASSERT_EQ(assembly.joins.size(), 4U);
  for (const AssemblyJoin& join : assembly.joins) {
    EXPECT_EQ(join.proposed, !(join.a == 2 && join.b == 3)) << join.a << " and " << join.b;
    EXPECT_GT(join.contact, 80.0) << join.a << " and " << join.b;
  }
}

TEST(Assembly, TakesOffAPieceInTheWayOfABetterJoin) {
  const planted::Board board = planted::broken_board(3, 1, 0.05, 42);
  const double length = perimeter(board.pieces[0].outline.points);
  std::vector<Silhouette> shapes;
  shapes.reserve(3);
  for (const Piece& piece : board.pieces) shapes.emplace_back(piece.outline, length / 640.0, 1.0);
  Layout layout(shapes, length / 400.0);
  layout.merge(0, 1, inverse(board.poses[0]) * board.poses[1]);
  layout.merge(0, 2, inverse(board.poses[0]) * board.poses[2]);
  EXPECT_EQ(layout.members(0).size(), 3U);
  EXPECT_GT(layout.support(1), layout.support(0));
  layout.take_off(1);
  EXPECT_EQ(layout.members(layout.group(1)).size(), 1U);
  layout.split_loose(layout.group(0), 1.0);
  EXPECT_NE(layout.group(0), layout.group(2)) << "nothing holds the outer pieces together";
}

TEST(Assembly, SpreadsTheErrorOverAllJoins) {
  const planted::Board board = planted::broken_board(2, 2, 0.0, 51);
  const double step = perimeter(board.pieces[0].outline.points) / 640.0;
  std::vector<Silhouette> shapes;
  shapes.reserve(4);
  for (const Piece& piece : board.pieces) shapes.emplace_back(piece.outline, step, 1.0);
  Layout layout(shapes, 1.5 * step);
  for (const std::size_t i : {1U, 2U, 3U}) {
    // Each a little off, in its own way.
    const Planar off{0.002, {0.3 * (static_cast<double>(i) - 2.0), 0.3}, false};
    layout.merge(0, i, inverse(board.poses[0]) * off * board.poses[i]);
  }
  layout.spread_error(0, 2.0 * step, 12);
  const Planar to_board = board.poses[0] * inverse(layout.pose(0));
  for (const std::size_t i : {1U, 2U, 3U})
    EXPECT_LT(planted::misplacement(board.pieces[i], to_board * layout.pose(i), board.poses[i]), 0.15);
}

TEST(Assembly, OfACancelledSearchHoldsEveryPiece) {
  const planted::Board board = planted::broken_board(2, 2, 0.05, 61);
  Context context;
  context.cancel();
  const Assembly assembly = assembled(board.pieces, context);
  EXPECT_TRUE(assembly.cancelled);
  EXPECT_EQ(assembly.placements.size(), 4U);
  EXPECT_EQ(assembly.untried.size(), 4U);
  EXPECT_TRUE(assembly.unplaced.empty());
}

TEST(Assembly, CancelledWhileItGrowsKeepsWhatItJoined) {
  const planted::Board board = planted::broken_board(3, 2, 0.05, 61);
  Context* stop = nullptr;
  Context context([&](std::string_view stage, double /*fraction*/) {
    if (stage == "assembling") stop->cancel();
  });
  stop = &context;
  const Assembly assembly = assembled(board.pieces, context);
  EXPECT_TRUE(assembly.cancelled);
  EXPECT_EQ(assembly.unplaced.size(), 4U) << "two of six are joined, then it ends";
}

/// Half of a long board that meets the other half along a short, finely bent line only, from where both lean back.
Outline leaning_half(bool left, double above_deg, double below_deg) {
  const double side = left ? -1.0 : 1.0;
  const auto line = [](double y) { return 0.6 * std::sin(2.1 * y) + 0.5 * std::sin(1.3 * y + 1.0); };
  const auto leaning = [&](double degrees) { return 300.0 * side * std::tan(degrees * 0.0174532925); };
  std::vector<glm::dvec2> corners;
  for (double y = -20.0; y <= 20.0; y += 0.25) corners.emplace_back(line(y), y);
  corners.emplace_back(line(20.0) + leaning(above_deg), 320.0);
  corners.emplace_back(side * 400.0, 320.0);
  corners.emplace_back(side * 400.0, -320.0);
  corners.emplace_back(line(-20.0) + leaning(below_deg), -320.0);
  if (!left) std::ranges::reverse(corners);
  if (signed_area(corners) < 0.0) std::ranges::reverse(corners);
  Outline outline;
  outline.points = resample_by(corners, 0.5);
  return outline;
}

// At a coarse scale the borders beyond the join draw at each other, too.
TEST(Assembly, LeavesAShortSureJoinWhereTheSearchPutIt) {
  const std::vector<Piece> pieces{{"left", "left", leaning_half(true, 3.0, 12.0)},
                                  {"right", "right", leaning_half(false, 3.0, 12.0)}};
  JoinCandidate join;
  join.score = 0.9999;
  const Assembly assembly = assemble(pieces, {{{join}}}, {}, Context());
  ASSERT_EQ(assembly.joins.size(), 1U);
  EXPECT_TRUE(assembly.joins[0].proposed);
  const Planar placed = inverse(assembly.placements[0].pose) * assembly.placements[1].pose;
  EXPECT_LT(glm::length(placed({0.0, 0.0})), 3.0);
  EXPECT_LT(std::abs(angle_between(placed, Planar{})), 0.02);
}

TEST(Assembly, TellsOfACandidateThatNothingElseBearsOut) {
  const planted::Board board = planted::broken_board(2, 1, 0.05, 62);
  JoinCandidate lone;
  lone.score = kSureScore;
  lone.pose = Planar{0.0, {5000.0, 0.0}, false};  // they do not even touch
  const Assembly assembly = assemble(board.pieces, {{{lone}}}, {}, Context());
  ASSERT_EQ(assembly.unplaced.size(), 2U);
  ASSERT_EQ(assembly.refused.size(), 2U);
  EXPECT_EQ(assembly.refused[1].at, 0U);
  Context cancelled;
  cancelled.cancel();
  EXPECT_TRUE(assemble(board.pieces, {{{lone}}}, {}, cancelled).refused.empty());
}

// The third piece takes the second one's place.
TEST(Assembly, TellsOfAPieceWithoutAPlaceWhereItWouldFit) {
  const planted::Board board = planted::broken_board(3, 1, 0.05, 62);
  JoinCandidate true_one;
  true_one.score = 0.9999;
  true_one.pose = inverse(board.poses[0]) * board.poses[1];
  JoinCandidate other = true_one;
  other.score = 0.8;
  other.pose = true_one.pose * Planar{0.0, {2.0, 0.0}, false} * inverse(board.poses[1]) * board.poses[2] *
               Planar{0.0, {1.0, 0.0}, false};
  const std::vector<PairResult> pairs{{{true_one}}, {{other}}, {}};
  const Assembly assembly = assemble(board.pieces, pairs, {}, Context());
  ASSERT_EQ(assembly.unplaced, std::vector<std::size_t>{2});
  ASSERT_EQ(assembly.refused.size(), 1U);
  EXPECT_EQ(assembly.refused[0].piece, 2U);
  EXPECT_EQ(assembly.refused[0].at, 0U);
  EXPECT_EQ(assembly.refused[0].score, 0.8);
}

TEST(Assembly, OfNoPiecesIsEmpty) {
  EXPECT_TRUE(assembled({}).placements.empty());
}

}  // namespace
}  // namespace rejoin::outline
