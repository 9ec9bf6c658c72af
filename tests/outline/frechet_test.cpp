#include "outline/frechet.hpp"

#include <gtest/gtest.h>

#include "core/cyclic.hpp"
#include "outline/emd.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

constexpr double kStep = 0.8;

/// Both plots of a board of two pieces and the sample at which the middle of the cut meets.
struct Cut {
  explicit Cut(std::uint64_t seed)
      : board(planted::broken_board(2, 1, 0.02, seed)),
        a(board.pieces[0].outline, {kStep, 2.0, false}),
        b(board.pieces[1].outline, {kStep, 2.0, true}) {
    const glm::dvec2 middle(100.0, 50.0);
    moment.a = nearest(a, board.poses[0], middle);
    moment.b = nearest(b, board.poses[1], board.poses[0](a.points[moment.a]));
  }

  static std::size_t nearest(const PropertyPlot& plot, const Planar& pose, const glm::dvec2& target) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < plot.size(); ++i)
      if (glm::distance(pose(plot.points[i]), target) < glm::distance(pose(plot.points[best]), target))
        best = i;
    return best;
  }

  planted::Board board;
  PropertyPlot a;
  PropertyPlot b;
  Moment moment;
};

/// Length of the cut itself: of piece a's samples that lie on piece b's border.
double cut_length(const Cut& cut) {
  std::size_t count = 0;
  for (const glm::dvec2& p : cut.a.points) {
    const glm::dvec2 at = cut.board.poses[0](p);
    const std::size_t i = Cut::nearest(cut.b, cut.board.poses[1], at);
    if (glm::distance(cut.board.poses[1](cut.b.points[i]), at) < 1.0) ++count;
  }
  return static_cast<double>(count) * kStep;
}

TEST(CommonBoundary, IsTheWholeCut) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Cut cut(seed);
    const Stretch stretch = longest_boundary(cut.a, cut.b, cut.moment, {});
    // At each end the smoothing reaches over 6 samples and the turn over 2 more.
    EXPECT_NEAR(kStep * static_cast<double>(stretch.a.size()), cut_length(cut), 16.0 * kStep) << seed;
    EXPECT_LT(planted::misplacement(cut.board.pieces[1], aligned(cut.a, cut.b, stretch),
                                    inverse(cut.board.poses[0]) * cut.board.poses[1]),
              1.0);
  }
}

TEST(CommonBoundary, ShrinksWithEpsilon) {
  const Cut cut(4);
  BoundaryOptions strict;
  strict.epsilon = 1e-5;
  const std::size_t loose = longest_boundary(cut.a, cut.b, cut.moment, {}).a.size();
  EXPECT_LT(longest_boundary(cut.a, cut.b, cut.moment, strict).a.size(), loose);
}

TEST(Frechet, StretchKeepsWithinTheTolerance) {
  const Cut cut(1);
  const Planar truth = inverse(cut.board.poses[0]) * cut.board.poses[1];
  const Stretch stretch = longest_frechet(cut.a, cut.b, cut.moment, {1.5, 20, 2});
  EXPECT_NEAR(kStep * static_cast<double>(stretch.a.size()), cut_length(cut), 12.0 * kStep);
  for (std::size_t k = 0; k < stretch.a.size(); ++k) {
    const std::size_t i = wrapped(stretch.a[k], cut.a.size());
    const std::size_t j = wrapped(stretch.b[k], cut.b.size());
    // The tolerance, and what the fitted pose is off the true one.
    EXPECT_LT(glm::distance(cut.a.points[i], truth(cut.b.points[j])), 2.5);
    const long before = stretch.a[k > 0 ? k - 1 : 0];
    EXPECT_LE(std::abs(stretch.a[k] - before), 1);
  }
}

TEST(Frechet, NothingMeetsWhereTheBordersAreApart) {
  const Cut cut(2);
  Moment wrong = cut.moment;
  wrong.a += 30;
  const Stretch stretch = longest_frechet(cut.a, cut.b, wrong, {0.01, 20, 2});
  EXPECT_LT(stretch.a.size(), 10U);
}

TEST(Frechet, FindsThePlantedJoin) {
  const planted::Board board = planted::broken_board(2, 1, 0.02, 5);
  const auto matcher = make_frechet();
  matcher->prepare(board.pieces);
  const PairResult result = matcher->match(0, 1, Context());
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_LT(planted::misplacement(board.pieces[1], result.candidates[0].pose,
                                  inverse(board.poses[0]) * board.poses[1]),
            1.0);
}

TEST(Aligned, IsTheMotionOfTheSamples) {
  const Cut cut(6);
  PropertyPlot moved = cut.a;
  const Planar motion{0.7, {30.0, -12.0}, false};
  for (glm::dvec2& p : moved.points) p = motion(p);
  Stretch stretch;
  for (long i = -5; i < 40; ++i) {
    stretch.a.push_back(i);
    stretch.b.push_back(i);
  }
  const Planar found = aligned(moved, cut.a, stretch);
  EXPECT_NEAR(found.angle_rad, 0.7, 1e-9);
  EXPECT_NEAR(glm::distance(found.translation, motion.translation), 0.0, 1e-7);
}

}  // namespace
}  // namespace rejoin::outline
