/// Pieces that are one and the same.
#include "outline/congruence.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planted.hpp"

namespace rejoin::outline {
namespace {

TEST(Congruence, APieceIsCongruentWithItsOtherScansOnly) {
  const planted::Board board = planted::broken_board(3, 3, 0.05, 12);
  Random random(5);
  for (std::size_t i = 0; i < board.pieces.size(); ++i) {
    const Piece again = planted::moved(board.pieces[i], {2.0, {900.0, 40.0}, false}, 0.1, random);
    for (std::size_t k = 0; k < board.pieces.size(); ++k)
      EXPECT_EQ(congruent(board.pieces[k].outline, again.outline), k == i) << k << " and " << i << " again";
  }
}

TEST(Congruence, HoldsWhereverABorderBegins) {
  const planted::Board board = planted::broken_board(1, 1, 0.05, 12);
  Outline turned = board.pieces[0].outline;
  std::rotate(turned.points.begin(), turned.points.begin() + 77, turned.points.end());
  EXPECT_TRUE(congruent(board.pieces[0].outline, turned));
}

TEST(Congruence, AMirroredPieceIsCongruentTurnedOver) {
  const planted::Board board = planted::broken_board(2, 1, 0.05, 12);
  Random random(6);
  const Outline& piece = board.pieces[0].outline;
  const Outline turned = planted::moved(board.pieces[0], {2.0, {900.0, 40.0}, false}, 0.1, random).outline;
  Outline mirrored = planted::moved(board.pieces[0], {1.0, {-70.0, 40.0}, true}, 0.1, random).outline;
  std::reverse(mirrored.points.begin(), mirrored.points.end());
  EXPECT_FALSE(congruent(piece, mirrored));
  EXPECT_TRUE(congruent(turned_over(piece), mirrored));
  EXPECT_FALSE(congruent(turned_over(piece), turned));
  EXPECT_FALSE(congruent(turned_over(board.pieces[1].outline), mirrored));
}

// A rectangle has corners for its only points, which are far apart: that does not make it another one.
TEST(Congruence, RectanglesOfOneAreaAreCongruentIfTheirSidesAre) {
  const Outline a{{{0, 0}, {100, 0}, {100, 50}, {0, 50}}, {}, {}};
  const Outline upright{{{0, 0}, {50, 0}, {50, 100}, {0, 100}}, {}, {}};
  const Outline shorter{{{0, 0}, {97, 0}, {97, 51.5}, {0, 51.5}}, {}, {}};
  EXPECT_TRUE(congruent(a, upright));
  EXPECT_FALSE(congruent(a, shorter));
}

}  // namespace
}  // namespace rejoin::outline
