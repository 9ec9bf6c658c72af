#include "outline/emd.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "outline/contact.hpp"
#include "outline/frechet.hpp"
#include "outline/lcs.hpp"
#include "outline/stitch.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

/// Length of the first piece's border that lies along the second's, by the truth.
double touching_length(const planted::Board& board) {
  const Planar placed = inverse(board.poses[1]) * board.poses[0];
  const DistanceField field(board.pieces[1].outline, 0.25, 2.0);
  const std::vector<glm::dvec2>& border = board.pieces[0].outline.points;
  double length = 0.0;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const glm::dvec2& next = border[(i + 1) % border.size()];
    if (std::abs(field(placed(0.5 * (border[i] + next)))) < 0.5) length += glm::distance(border[i], next);
  }
  return length;
}

/// The first two pieces of a board.
PairResult matched(const planted::Board& board) {
  const auto matcher = make_emd();
  matcher->prepare(board.pieces);
  return matcher->match(0, 1, Context());
}

TEST(Emd, FindsThePlantedJoinOfTwoPieces) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const planted::Board board = planted::broken_board(2, 1, 0.05, seed);
    const PairResult result = matched(board);
    ASSERT_FALSE(result.candidates.empty());
    const Planar truth = inverse(board.poses[0]) * board.poses[1];
    EXPECT_LT(angle_between(result.candidates[0].pose, truth), 0.01) << "seed " << seed;
    EXPECT_LT(planted::misplacement(board.pieces[1], result.candidates[0].pose, truth), 0.5)
        << "seed " << seed;
  }
}

TEST(Emd, FollowsTheScaleOfTheFiles) {
  planted::Board board = planted::broken_board(2, 1, 0.05, 4);
  const auto matcher = make_emd();
  matcher->prepare(board.pieces);
  const PairResult plain = matcher->match(0, 1, Context());
  for (Piece& piece : board.pieces)
    for (glm::dvec2& p : piece.outline.points) p = 1024.0 * p;
  matcher->prepare(board.pieces);
  const PairResult large = matcher->match(0, 1, Context());
  ASSERT_FALSE(plain.candidates.empty());
  ASSERT_FALSE(large.candidates.empty());
  EXPECT_NEAR(plain.candidates[0].pose.angle_rad, large.candidates[0].pose.angle_rad, 1e-6);
  EXPECT_NEAR(plain.candidates[0].boundary.length, large.candidates[0].boundary.length / 1024.0, 1e-3);
}

// The planted borders are 0.05 off each other along one rough side: with the stretch's ends in the right place no wedge lies
// between them.
TEST(Emd, TheBoundaryRunsAsFarAsThePiecesTouch) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const planted::Board board = planted::broken_board(2, 1, 0.05, seed);
    const PairResult result = matched(board);
    ASSERT_FALSE(result.candidates.empty());
    const JoinCandidate& best = result.candidates[0];
    // The two outlines have no other common line; where a sample is counted to, the length is off by a step or two an end.
    const double step = median_perimeter(board.pieces) / 240.0;
    EXPECT_NEAR(best.boundary.length, touching_length(board), 4.0 * step) << seed;
    const JoinAreas areas = join_areas(board.pieces[0].outline, board.pieces[1].outline, best);
    EXPECT_LT(areas.gap + areas.overlap, 0.5 * best.boundary.length) << seed;
  }
}

// A larger piece and a smaller one, in either order.
void expect_the_same_either_way(const Matcher& matcher, const std::vector<Piece>& pieces) {
  const PairResult one = matcher.match(0, 1, Context());
  const PairResult other = matcher.match(1, 0, Context());
  ASSERT_FALSE(one.candidates.empty());
  ASSERT_EQ(one.candidates.size(), other.candidates.size());
  const auto place = [&](std::size_t piece, double distance) {
    const std::vector<glm::dvec2>& border = pieces[piece].outline.points;
    return point_at(border, arc_lengths(border), distance);
  };
  for (std::size_t k = 0; k < one.candidates.size(); ++k) {
    EXPECT_EQ(one.candidates[k].score, other.candidates[k].score);
    EXPECT_LT(planted::misplacement(pieces[1], one.candidates[k].pose, inverse(other.candidates[k].pose)),
              1e-9);
  }
  const Boundary& met = other.candidates[0].boundary;
  EXPECT_LT(glm::distance(place(1, met.begin_a), other.candidates[0].pose(place(0, met.begin_b))),
            4.0 * median_perimeter(pieces) / 240.0);
}

TEST(Emd, OrderOfThePiecesDoesNotMatter) {
  planted::Board board = planted::broken_board(3, 1, 0.05, 5);
  board.pieces.erase(board.pieces.begin() + 2);
  for (const auto& make : {std::function(make_emd), std::function(make_frechet)}) {
    const auto matcher = make({});
    matcher->prepare(board.pieces);
    expect_the_same_either_way(*matcher, board.pieces);
  }
  const auto lcs = make_lcs();
  lcs->prepare(board.pieces);
  expect_the_same_either_way(*lcs, board.pieces);
}

TEST(Emd, SaysLittleOfPiecesThatDoNotJoin) {
  const planted::Board board = planted::broken_board(3, 1, 0.05, 5);
  const auto matcher = make_emd();
  matcher->prepare(board.pieces);
  const PairResult joined = matcher->match(0, 1, Context());
  const PairResult apart = matcher->match(0, 2, Context());
  ASSERT_FALSE(joined.candidates.empty());
  const double other = apart.candidates.empty() ? 0.0 : apart.candidates[0].score;
  EXPECT_LT(other, 0.7 * joined.candidates[0].score);
}

}  // namespace
}  // namespace rejoin::outline
