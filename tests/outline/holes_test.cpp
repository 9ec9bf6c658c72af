// Pieces that lie in a hole of another.
#include <gtest/gtest.h>

#include "outline/assembly.hpp"
#include "outline/contact.hpp"
#include "outline/multiscale.hpp"
#include "outline/stitch.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

using planted::Board;

constexpr double kNoise = 0.05;  // the boards' points are 1.6 units apart

Board board_with_plug(double radius, std::uint64_t seed) {
  Board board = planted::broken_board(2, 2, kNoise, seed);
  planted::break_out_plug(board, radius, kNoise, seed + 1000);
  return board;
}

PairResult matched(const std::vector<Piece>& pieces, std::size_t a, std::size_t b,
                   const MultiscaleOptions& options = {}) {
  const auto matcher = make_multiscale(options);
  matcher->prepare(pieces);
  return matcher->match(a, b, Context());
}

TEST(Holes, APieceIsFoundInTheHoleItCameFrom) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Board board = board_with_plug(22.0, seed);
    const Piece& plug = board.pieces[4];
    const PairResult result = matched(board.pieces, 0, 4);
    ASSERT_FALSE(result.candidates.empty()) << seed;
    const JoinCandidate& best = result.candidates[0];
    EXPECT_GT(best.score, kSureScore) << seed;
    EXPECT_EQ(best.boundary.hole_a, 1U) << seed;
    EXPECT_EQ(best.boundary.hole_b, 0U) << seed;
    const Planar truth = inverse(board.poses[0]) * board.poses[4];
    EXPECT_LT(planted::misplacement(plug, best.pose, truth), 0.5) << seed;
    const double around = perimeter(plug.outline.points);
    EXPECT_NEAR(best.boundary.length, around, 0.1 * around) << seed;
    // The hole is open: what both cover, and what neither does, is the noise along the border.
    const JoinAreas areas = join_areas(board.pieces[0].outline, plug.outline, best);
    EXPECT_LT(areas.overlap, 0.2 * around) << seed;
    EXPECT_LT(areas.gap, 0.2 * around) << seed;
  }
}

TEST(Holes, TheOrderOfThePairDoesNotMatter) {
  const Board board = board_with_plug(22.0, 5);
  const JoinCandidate best = matched(board.pieces, 4, 0).candidates.at(0);
  EXPECT_EQ(best.boundary.hole_a, 0U);
  EXPECT_EQ(best.boundary.hole_b, 1U);
  EXPECT_LT(planted::misplacement(board.pieces[0], best.pose, inverse(board.poses[4]) * board.poses[0]), 2.0);
}

TEST(Holes, BoundaryBeginsOnTheHoleWhereThePieceBegins) {
  const Board board = board_with_plug(22.0, 6);
  const JoinCandidate best = matched(board.pieces, 0, 4).candidates.at(0);
  const std::vector<glm::dvec2>& hole = border_of(board.pieces[0].outline, best.boundary.hole_a);
  const std::vector<glm::dvec2>& plug = board.pieces[4].outline.points;
  EXPECT_LT(signed_area(hole), 0.0);
  for (const double share : {0.0, 0.3, 0.6}) {
    const double along = share * best.boundary.length;
    const glm::dvec2 on_a = point_at(hole, arc_lengths(hole), best.boundary.begin_a + along);
    const glm::dvec2 on_b = point_at(plug, arc_lengths(plug), best.boundary.begin_b - along);
    EXPECT_LT(glm::distance(on_a, best.pose(on_b)), 2.5) << share;  // both lengths are off by the noise
  }
}

TEST(Holes, PairsWithoutHolesKeepTheirResults) {
  const Board plain = planted::broken_board(2, 2, kNoise, 7);
  Board holed = plain;
  planted::break_out_plug(holed, 22.0, kNoise, 8);
  holed.pieces.pop_back();  // the set's mean border stays
  const PairResult before = matched(plain.pieces, 1, 3);
  const PairResult after = matched(holed.pieces, 1, 3);
  ASSERT_EQ(before.candidates.size(), after.candidates.size());
  for (std::size_t k = 0; k < before.candidates.size(); ++k) {
    EXPECT_EQ(before.candidates[k].score, after.candidates[k].score);
    EXPECT_EQ(before.candidates[k].pose.translation, after.candidates[k].pose.translation);
  }
}

TEST(Holes, ThoseBelowTheShortestBoundaryAreNotCompared) {
  const Board board = board_with_plug(22.0, 9);
  const auto best_hole = [](const PairResult& result) {
    std::size_t hole = 0;
    for (const JoinCandidate& candidate : result.candidates) hole = std::max(hole, candidate.boundary.hole_a);
    return hole;
  };
  EXPECT_EQ(best_hole(matched(board.pieces, 0, 4)), 1U);
  MultiscaleOptions long_only;
  long_only.min_length = 1.01 * perimeter(border_of(board.pieces[0].outline, 1));
  EXPECT_EQ(best_hole(matched(board.pieces, 0, 4, long_only)), 0U);
}

TEST(Holes, AssemblyPlacesTheFillingAndThePiecesAround) {
  for (std::uint64_t seed = 11; seed <= 13; ++seed) {
    const Board board = board_with_plug(22.0, seed);
    const auto matcher = make_multiscale();
    matcher->prepare(board.pieces);
    const Assembly assembly = assemble(board.pieces, *matcher, {}, Context());
    EXPECT_TRUE(assembly.unplaced.empty()) << seed;
    for (std::size_t i = 1; i < board.pieces.size(); ++i) {
      const Planar placed = inverse(assembly.placements[0].pose) * assembly.placements[i].pose;
      const Planar truth = inverse(board.poses[0]) * board.poses[i];
      EXPECT_LT(planted::misplacement(board.pieces[i], placed, truth), 2.0) << seed << ", piece " << i;
    }
    const auto join = std::find_if(assembly.joins.begin(), assembly.joins.end(),
                                   [](const AssemblyJoin& j) { return j.a == 0 && j.b == 4; });
    ASSERT_NE(join, assembly.joins.end()) << seed;
    const double around = perimeter(board.pieces[4].outline.points);
    EXPECT_NEAR(join->contact, around, 0.03 * around) << seed;
  }
}

TEST(Holes, AssemblyLeavesAStrangerOfTheHolesSizeOut) {
  std::size_t placed = 0;
  for (std::uint64_t seed = 21; seed <= 50; ++seed) {
    Board board = board_with_plug(12.0, seed);
    board.pieces[4] = board_with_plug(12.0, seed + 100).pieces[4];
    const auto matcher = make_multiscale();
    matcher->prepare(board.pieces);
    const Assembly assembly = assemble(board.pieces, *matcher, {}, Context());
    if (assembly.placements[4].group == assembly.placements[0].group) ++placed;
  }
  EXPECT_EQ(placed, 0U);
}

Outline square_with_hole() {
  Outline ring;
  ring.points = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  ring.holes = {{{40, 40}, {40, 60}, {60, 60}, {60, 40}}};
  return ring;
}

TEST(Holes, GapOfAWornFillingIsWhatItLeavesOfTheHole) {
  const Outline ring = square_with_hole();
  const Outline worn{{{41, 41}, {59, 41}, {59, 59}, {41, 59}}, {}, {}};
  JoinCandidate join;
  join.boundary = {0.0, 0.0, 76.0, 1, 0};
  const JoinAreas areas = join_areas(ring, worn, join);
  EXPECT_EQ(areas.overlap, 0.0);
  // The stretch on A ends 4 units before it has gone round: a triangle of that side, a unit high, is missing.
  EXPECT_NEAR(areas.gap, 400.0 - 324.0 - 2.0, 1e-6);
}

TEST(Holes, OutsideOfAPieceIsInItsHole) {
  const Outline ring = square_with_hole();
  const Silhouette holed(ring, 1.0, 0.0);
  EXPECT_LT(holed.field({50, 50}), 0.0);
  EXPECT_NEAR(holed.field({37, 50}), 3.0, 0.1);
  EXPECT_EQ(holed.points.size(), 480U);
  // Into the hole, away from the piece.
  EXPECT_GT(glm::dot(holed.normals[410], glm::dvec2(50, 50) - holed.points[410]), 0.0);
  // At a step of 10 the hole's border is 8 steps long and has no shape.
  EXPECT_GT(Silhouette(ring, 10.0, 0.0).field({50, 50}), 0.0);
}

}  // namespace
}  // namespace rejoin::outline
