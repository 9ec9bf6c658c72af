#include "outline/emd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "outline/contact.hpp"
#include "outline/frechet.hpp"
#include "outline/lcs.hpp"
#include "outline/polygon.hpp"
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

/// Every pair of a set and of the same set the other way round.
void expect_the_same_either_way(Matcher& matcher, const std::vector<Piece>& pieces) {
  std::vector<Piece> reversed(pieces.rbegin(), pieces.rend());
  const std::size_t last = pieces.size() - 1;
  const auto place = [&](std::size_t piece, double distance) {
    const std::vector<glm::dvec2>& border = pieces[piece].outline.points;
    EXPECT_LT(distance, perimeter(border));
    return point_at(border, arc_lengths(border), distance);
  };
  matcher.prepare(pieces);
  std::vector<PairResult> found;
  for (std::size_t a = 0; a < last; ++a)
    for (std::size_t b = a + 1; b <= last; ++b) found.push_back(matcher.match(a, b, Context()));
  matcher.prepare(reversed);
  auto one = found.begin();
  std::size_t compared = 0;
  for (std::size_t a = 0; a < last; ++a) {
    for (std::size_t b = a + 1; b <= last; ++b, ++one) {
      const PairResult other = matcher.match(last - b, last - a, Context());
      ASSERT_EQ(one->candidates.size(), other.candidates.size());
      for (std::size_t k = 0; k < other.candidates.size(); ++k, ++compared) {
        const JoinCandidate& told = other.candidates[k];
        EXPECT_EQ(one->candidates[k].score, told.score);
        EXPECT_LT(planted::misplacement(pieces[b], one->candidates[k].pose, inverse(told.pose)), 1e-9);
        if (told.score < kSureScore) continue;
        EXPECT_LT(glm::distance(place(b, told.boundary.begin_a), told.pose(place(a, told.boundary.begin_b))),
                  0.05 * median_perimeter(pieces));
      }
    }
  }
  EXPECT_GE(compared, 2U);
}

TEST(Emd, OrderOfThePiecesDoesNotMatter) {
  const planted::Board board = planted::broken_board(3, 1, 0.05, 5);
  for (const auto& make : {std::function(make_emd), std::function(make_frechet)})
    expect_the_same_either_way(*make({}), board.pieces);
  expect_the_same_either_way(*make_lcs(), board.pieces);
}

/// A piece whose border zigzags from point to point, as a noisy scan's does, so that it is longer.
Piece zigzagged(Piece piece, double aside) {
  std::vector<glm::dvec2> points;
  const std::vector<glm::dvec2>& border = piece.outline.points;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const glm::dvec2 along = border[(i + 1) % border.size()] - border[i];
    const double side = i % 2 == 0 ? aside : -aside;
    points.push_back(border[i]);
    points.push_back(border[i] + 0.5 * along + side * glm::dvec2(-along.y, along.x));
  }
  piece.outline.points = std::move(points);
  return piece;
}

TEST(Emd, EitherWayTheBoundaryBeginsWhereThePiecesMeetThoughOneBorderIsLonger) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    planted::Board board = planted::broken_board(2, 1, 0.02, seed);
    const double before = perimeter(board.pieces[1].outline.points);
    board.pieces[1] = zigzagged(board.pieces[1], 0.22);
    ASSERT_GT(perimeter(board.pieces[1].outline.points), 1.08 * before);
    const double most = 3.0 * median_perimeter(board.pieces) / 240.0;
    for (const auto& matcher : {make_lcs(), make_emd()}) {
      matcher->prepare(board.pieces);
      for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0)}) {
        const PairResult result =
            matcher->match(static_cast<std::size_t>(a), static_cast<std::size_t>(b), {});
        ASSERT_FALSE(result.candidates.empty());
        const JoinCandidate& best = result.candidates[0];
        const auto place = [&](int piece, double distance) {
          const std::vector<glm::dvec2>& border =
              board.pieces[static_cast<std::size_t>(piece)].outline.points;
          return point_at(border, arc_lengths(border), distance);
        };
        EXPECT_LT(glm::distance(place(a, best.boundary.begin_a), best.pose(place(b, best.boundary.begin_b))),
                  most)
            << seed << " " << a;
      }
    }
  }
}

TEST(Emd, TheBoundaryBeginsOnTheBorderOfAPieceWithAHole) {
  planted::Board board = planted::broken_board(2, 1, 0.02, 2);
  std::vector<glm::dvec2>& border = board.pieces[1].outline.points;
  const glm::dvec2 middle = inner_point(border);
  board.pieces[1].outline.holes = {
      {middle, middle + glm::dvec2(0, 20), middle + 20.0, middle + glm::dvec2(20, 0)}};
  const auto matcher = make_emd();
  for (int turn = 0; turn < 40; ++turn) {
    std::rotate(border.begin(), border.begin() + static_cast<std::ptrdiff_t>(border.size() / 40),
                border.end());
    matcher->prepare(board.pieces);
    for (const JoinCandidate& candidate : matcher->match(0, 1, Context()).candidates) {
      EXPECT_GE(candidate.boundary.begin_b, 0.0);
      EXPECT_LT(candidate.boundary.begin_b, perimeter(border)) << turn;
    }
  }
}

TEST(Emd, APieceInAnotherUnitIsNotCompared) {
  planted::Board board = planted::broken_board(3, 1, 0.05, 5);
  for (glm::dvec2& p : board.pieces[2].outline.points) p *= 1e7;
  const auto matcher = make_emd();
  matcher->prepare(board.pieces);
  EXPECT_TRUE(matcher->match(1, 2, Context()).candidates.empty());
  EXPECT_FALSE(matcher->match(0, 1, Context()).candidates.empty());
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
