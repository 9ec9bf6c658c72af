#include "outline/emd.hpp"

#include <gtest/gtest.h>

#include "planted.hpp"

namespace rejoin::outline {
namespace {

TEST(Emd, FindsThePlantedJoinOfTwoPieces) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const planted::Board board = planted::broken_board(2, 1, 0.05, seed);
    const auto matcher = make_emd();
    matcher->prepare(board.pieces);
    const PairResult result = matcher->match(0, 1, Context());
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
