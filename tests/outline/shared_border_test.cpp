#include "outline/shared_border.hpp"

#include <gtest/gtest.h>

#include "core/parallel.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

Piece rectangle(double width, double height) {
  Piece piece;
  piece.outline.points = {{0, 0}, {width, 0}, {width, height}, {0, height}};
  return piece;
}

TEST(SharedBorder, OfTwoRectanglesIsTheirCommonSideAndItsGap) {
  const std::vector<Piece> pieces{rectangle(100, 40), rectangle(60, 40)};
  const Planar right{0.0, {100.5, 0.0}, false};
  const auto shared = shared_borders(pieces, {0, 1}, {Planar{}, right}, 2.0);
  ASSERT_EQ(shared.size(), 1U);
  EXPECT_EQ(shared[0].a, 0U);
  EXPECT_EQ(shared[0].b, 1U);
  // At either end the borders stay within reach for less than two units of each side beyond the corner.
  EXPECT_NEAR(shared[0].length, 40.0, 4.0);
  EXPECT_GE(shared[0].length, 40.0);
  // Samples are half a unit apart, so the nearest may be a quarter of one aside.
  EXPECT_NEAR(shared[0].rms, 0.5, 0.15);
}

TEST(SharedBorder, CountsNothingTwiceWhereFourPiecesMeet) {
  const planted::Board board = planted::broken_board(3, 3, 0.02, 5);
  std::vector<std::size_t> all(9);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const auto shared = shared_borders(board.pieces, all, board.poses, 2.0);
  double around_middle = 0.0;
  double diagonal = 0.0;
  for (const SharedBorder& border : shared) {
    if (border.a == 4 || border.b == 4) around_middle += border.length;
    const std::size_t apart = border.b - border.a;
    if (apart == 2 || apart == 4) diagonal = std::max(diagonal, border.length);
  }
  // The middle piece lies between others on all sides.  The two sides of a border differ by their noise and by where
  // their points lie.
  EXPECT_NEAR(around_middle, perimeter(board.pieces[4].outline.points), 0.02 * around_middle);
  EXPECT_LT(diagonal, 4.0);
}

TEST(SharedBorder, IsTheSameForAnyNumberOfThreads) {
  const planted::Board board = planted::broken_board(2, 2, 0.1, 6);
  const auto many = shared_borders(board.pieces, {0, 1, 2, 3}, board.poses, 2.0);
  const ThreadLimit limit(1);
  const auto one = shared_borders(board.pieces, {0, 1, 2, 3}, board.poses, 2.0);
  ASSERT_EQ(many.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(many[i].length, one[i].length);
}

TEST(SharedBorder, OfDistantPiecesIsNone) {
  const std::vector<Piece> pieces{rectangle(100, 40), rectangle(60, 40)};
  EXPECT_TRUE(shared_borders(pieces, {0, 1}, {Planar{}, Planar{0.0, {-80.0, 0.0}, false}}, 2.0).empty());
  EXPECT_TRUE(shared_borders(pieces, {1}, {Planar{}, Planar{}}, 2.0).empty());
}

}  // namespace
}  // namespace rejoin::outline
