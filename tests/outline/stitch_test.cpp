#include "outline/stitch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "outline/detail/pose_fit.hpp"
#include "outline/polygon.hpp"
#include "outline/signal.hpp"
#include "planted.hpp"

namespace rejoin::outline {
namespace {

Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}, {}};
}

/// Points one unit apart.
std::vector<glm::dvec2> samples(const Outline& outline) {
  return resample(outline.points, static_cast<std::size_t>(std::lround(perimeter(outline.points))));
}

std::uint32_t nearest_to(const std::vector<glm::dvec2>& points, const glm::dvec2& p) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (glm::distance(points[i], p) < glm::distance(points[best], p)) best = i;
  return best;
}

TEST(Seam, OfTwoRectanglesIsTheirCommonSide) {
  const std::vector<glm::dvec2> a = samples(rectangle(0, 0, 100, 60));
  const std::vector<glm::dvec2> b = samples(rectangle(100, 0, 180, 60));
  const Seam seam = find_seam(a, b, {}, {nearest_to(a, {100, 30}), nearest_to(b, {100, 30})}, {0.5, 3});
  EXPECT_NEAR(seam.length, 60.0, 1.0);
  EXPECT_NEAR(seam.gap_area, 0.0, 1e-9);
  EXPECT_NEAR(seam.overlap_area, 0.0, 1e-9);
}

TEST(Seam, GapAndOverlapAreStripsAlongIt) {
  const std::vector<glm::dvec2> a = samples(rectangle(0, 0, 100, 60));
  const std::vector<glm::dvec2> b = samples(rectangle(100, 0, 180, 60));
  for (const double apart : {0.4, -0.4}) {
    const Planar pose{0.0, {apart, 0.0}, false};
    const Seam seam = find_seam(a, b, pose, {nearest_to(a, {100, 30}), nearest_to(b, {100, 30})}, {1.0, 3});
    EXPECT_NEAR(apart > 0 ? seam.gap_area : seam.overlap_area, 0.4 * 60.0,
                1.5);  // the ends turn away from the side
    EXPECT_NEAR(apart > 0 ? seam.overlap_area : seam.gap_area, 0.0, 1.5);
    EXPECT_NEAR(seam.mean_gap, apart, 0.05);
  }
}

TEST(Seam, OfAPieceUpsideDownRunsTheSameWayOnBoth) {
  const std::vector<glm::dvec2> a = samples(rectangle(0, 0, 100, 60));
  const std::vector<glm::dvec2> b = samples(rectangle(100, -60, 180, 0));
  const Planar pose{0.0, {0.0, 0.0}, true};
  const Seam seam = find_seam(a, b, pose, {nearest_to(a, {100, 30}), nearest_to(b, {100, -30})}, {0.5, 3});
  EXPECT_NEAR(seam.length, 60.0, 1.0);
}

TEST(Stitch, OverlapOfTwoSquaresIsExact) {
  EXPECT_NEAR(overlap_area(rectangle(0, 0, 10, 10), rectangle(0, 0, 10, 10), {0.0, {7.0, 4.0}, false}), 18.0,
              1e-6);
  EXPECT_NEAR(overlap_area(rectangle(0, 0, 10, 10), rectangle(0, 0, 10, 10), {0.0, {11.0, 0.0}, false}), 0.0,
              1e-9);
}

/// Two rectangles beside each other, B moved; their common side is 60 long, from A's and B's lower corners.
JoinAreas side_by_side(const Planar& pose) {
  const JoinCandidate join{pose, 1.0, {100.0, 0.0, 60.0}};
  return join_areas(rectangle(0, 0, 100, 60), rectangle(100, 0, 180, 60), join);
}

/// About the common lower corner.
Planar turned(double angle_rad) {
  const Planar turn{angle_rad, {}, false};
  return {angle_rad, glm::dvec2(100, 0) - turn.direction({100, 0}), false};
}

TEST(JoinAreas, AreStripsAndWedgesBesideAStraightSide) {
  EXPECT_NEAR(side_by_side({}).gap, 0.0, 1e-4);
  EXPECT_NEAR(side_by_side({}).overlap, 0.0, 1e-4);
  EXPECT_NEAR(side_by_side({0.0, {0.4, 0.0}, false}).gap, 24.0, 1e-4);
  EXPECT_NEAR(side_by_side({0.0, {0.4, 0.0}, false}).overlap, 0.0, 1e-9);
  EXPECT_NEAR(side_by_side({0.0, {-0.4, 0.0}, false}).gap, 0.0, 1e-4);
  EXPECT_NEAR(side_by_side({0.0, {-0.4, 0.0}, false}).overlap, 24.0, 1e-4);
  const double angle = 0.1;
  EXPECT_NEAR(side_by_side(turned(-angle)).gap, 0.5 * 60.0 * 60.0 * std::sin(angle), 1e-4);
  EXPECT_NEAR(side_by_side(turned(-angle)).overlap, 0.0, 1e-4);
  // Turned into A, less the tip that stands above it.
  const double tip = 60.0 / std::cos(angle) - 60.0;
  EXPECT_NEAR(side_by_side(turned(angle)).overlap,
              0.5 * 60.0 * 60.0 * std::tan(angle) - 0.5 * tip * tip / std::tan(angle), 1e-4);
}

TEST(JoinAreas, OfAPieceUpsideDownAreThoseOfItsMirrorImage) {
  const Planar over{0.0, {0.4, 0.0}, true};
  const JoinCandidate join{
      over, 1.0, {100.0, 220.0, 60.0}};  // B's lower corner at the side is its last point
  const JoinAreas areas = join_areas(rectangle(0, 0, 100, 60), rectangle(100, -60, 180, 0), join);
  EXPECT_NEAR(areas.gap, 24.0, 1e-4);
  EXPECT_NEAR(areas.overlap, 0.0, 1e-9);
}

/// Area of what lies in both by a fine raster.
double counted_overlap(const Outline& a, const Outline& b, const Planar& pose) {
  constexpr double kCell = 0.25;
  const Outline placed = moved(b, pose);
  glm::dvec2 low = a.points[0];
  glm::dvec2 high = low;
  for (const glm::dvec2& p : a.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  double cells = 0.0;
  for (double y = low.y + 0.5 * kCell; y < high.y; y += kCell)
    for (double x = low.x + 0.5 * kCell; x < high.x; x += kCell)
      if (contains(a.points, {x, y}) && contains(placed.points, {x, y})) cells += 1.0;
  return cells * kCell * kCell;
}

// Some 600 cells lie on the overlap's border, and each is off by half a cell at most, at random: a tenth of an unit squared
// a root of 600.
TEST(JoinAreas, OverlapOfRoughPiecesIsThatOfAFineRaster) {
  const planted::Board board = planted::broken_board(2, 1, 0.05, 3);
  const Planar truth = inverse(board.poses[0]) * board.poses[1];
  const Planar pressed = Planar{0.02, {3.0, -2.0}, false} * truth;
  for (const Planar& pose : {truth, pressed}) {
    const Outline& a = board.pieces[0].outline;
    const Outline& b = board.pieces[1].outline;
    EXPECT_NEAR(join_areas(a, b, {pose, 1.0, {}}).overlap, counted_overlap(a, b, pose), 3.0);
  }
}

TEST(Stitch, UnionClosesNarrowGapsAndKeepsTheRest) {
  const std::vector<Outline> placed{rectangle(0, 0, 50, 100), rectangle(51, 0, 100, 100)};
  EXPECT_EQ(unite(placed, 0.0).size(), 2U);
  const std::vector<Outline> closed = unite(placed, 2.0);
  ASSERT_EQ(closed.size(), 1U);
  EXPECT_NEAR(signed_area(closed[0].points), 10000.0, 1.0);  // the gap's two mouths stay a little open
}

TEST(Stitch, UnionKeepsHolesInThePartThatHoldsThem) {
  const std::vector<Outline> frame{rectangle(0, 0, 30, 10), rectangle(0, 20, 30, 30), rectangle(0, 0, 10, 30),
                                   rectangle(20, 0, 30, 30), rectangle(100, 0, 110, 10)};
  const std::vector<Outline> parts = unite(frame, 0.0);
  ASSERT_EQ(parts.size(), 2U);
  ASSERT_EQ(parts[0].holes.size(), 1U);
  EXPECT_NEAR(signed_area(parts[0].holes[0]), -100.0, 1e-4);
  EXPECT_TRUE(parts[1].holes.empty());
}

TEST(Stitch, MisfitIsTheWidthOfThePlantedStrips) {
  const Outline whole = rectangle(0, 0, 100, 100);
  const Misfit fits = misfit({rectangle(0, 0, 40, 100), rectangle(40, 0, 100, 100)}, whole);
  EXPECT_LT(std::max({fits.overlap, fits.gap, fits.excess}), 0.06);
  const Misfit planted =
      misfit({rectangle(0, 0, 43, 100), rectangle(40, 0, 95, 100), rectangle(95, 0, 99, 101)}, whole);
  EXPECT_NEAR(planted.overlap, 3.0, 0.1);
  EXPECT_NEAR(planted.gap, 1.0, 0.1);
  EXPECT_NEAR(planted.excess, 1.0, 0.1);
}

TEST(PoseFit, RecoversAPlantedMotionFromARoughStart) {
  Random random(3);
  for (const bool flipped : {false, true}) {
    const Planar truth{2.1, {340.0, -75.0}, flipped};
    std::vector<detail::PointPair> pairs;
    for (int i = 0; i < 20; ++i) {
      const glm::dvec2 p(random.uniform(0, 100), random.uniform(0, 100));
      pairs.push_back({truth(p), p, glm::dvec2(0.0)});
    }
    const Planar fitted = detail::fit_pose(pairs, {1.8, {300.0, -60.0}, flipped});
    EXPECT_LT(angle_between(fitted, truth), 1e-9);
    EXPECT_LT(glm::distance(fitted({50, 50}), truth({50, 50})), 1e-7);
    const Planar three = detail::pose_of_three(pairs, flipped);
    EXPECT_LT(angle_between(three, truth), 1e-9);
  }
}

TEST(PoseFit, NoisyPairsGiveTheClosedFormsAnswer) {
  Random random(4);
  const Planar truth{0.4, {10.0, 20.0}, false};
  std::vector<detail::PointPair> pairs;
  for (int i = 0; i < 30; ++i) {
    const glm::dvec2 p(random.uniform(0, 100), random.uniform(0, 100));
    pairs.push_back({truth(p) + glm::dvec2(random.normal(), random.normal()), p, glm::dvec2(0.0)});
  }
  glm::dvec2 mean_a(0.0);
  glm::dvec2 mean_b(0.0);
  for (const detail::PointPair& pair : pairs) {
    mean_a += pair.on_a / 30.0;
    mean_b += pair.on_b / 30.0;
  }
  double along = 0.0;
  double across = 0.0;
  for (const detail::PointPair& pair : pairs) {
    const glm::dvec2 u = pair.on_b - mean_b;
    const glm::dvec2 v = pair.on_a - mean_a;
    along += glm::dot(u, v);
    across += u.x * v.y - u.y * v.x;
  }
  EXPECT_NEAR(detail::fit_pose(pairs, {0.2, {0, 0}, false}).angle_rad, std::atan2(across, along), 1e-7);
}

TEST(PoseFit, WithNormalsPairsMaySlideAlongTheBorder) {
  // Two sides of a corner, each pair shifted along its side: the corner still comes to lie where it belongs.
  std::vector<detail::PointPair> pairs;
  for (int i = 1; i < 20; ++i) {
    const double at = 5.0 * i;
    pairs.push_back({{at, 0.0}, {at + (i % 2 == 0 ? 1.0 : -1.0), 3.0}, {0.0, -1.0}});
    pairs.push_back({{0.0, at}, {2.0, at + 3.0 + (i % 2 == 0 ? 1.0 : -1.0)}, {-1.0, 0.0}});
  }
  const Planar fitted = detail::fit_pose(pairs, {});
  EXPECT_LT(glm::distance(fitted({2.0, 3.0}), glm::dvec2(0.0)), 0.1);
}

}  // namespace
}  // namespace rejoin::outline
