#include "outline/multiscale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "shapes.hpp"

namespace rejoin::outline {
namespace {

using testing::broken_tile;
using testing::BrokenTile;

std::vector<Piece> pieces_of(const BrokenTile& tile) {
  return {{"lower", "", tile.lower}, {"upper", "", tile.upper}};
}

double worst_distance(const Planar& pose, const Planar& truth, const Outline& b) {
  double worst = 0.0;
  for (const glm::dvec2& p : b.points) worst = std::max(worst, glm::distance(pose(p), truth(p)));
  return worst;
}

TEST(Multiscale, BrokenTileIsPutTogether) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const BrokenTile tile =
        broken_tile(300, 120, {1.1 * static_cast<double>(seed), {500, -200}, false}, seed);
    const std::vector<Piece> pieces = pieces_of(tile);
    const auto matcher = make_multiscale();
    matcher->prepare(pieces);
    const PairResult result = matcher->match(0, 1, Context());
    ASSERT_FALSE(result.candidates.empty()) << seed;
    const JoinCandidate& best = result.candidates[0];
    EXPECT_LT(worst_distance(best.pose, tile.upper_to_lower, tile.upper), 1.5)
        << seed;  // a unit is a sample of the outline
    EXPECT_GT(best.score, 0.9) << seed;
    // The line's ends meet the tile's straight sides, where the smoothed borders part.
    const double whole = perimeter(tile.upper.points) - (300.0 + 2 * 120.0);
    EXPECT_NEAR(best.boundary.length, whole, 0.15 * whole) << seed;
  }
}

TEST(Multiscale, FindsALongJoinThoughItLooksForShortOnesAndTheFineScaleIsNoise) {
  for (std::uint64_t seed = 31; seed <= 33; ++seed) {
    BrokenTile tile = broken_tile(400, 120, {0.7, {500, -200}, false}, seed);
    Random random(seed + 1);
    // Points are a unit apart, so directions from one to the next are off by half a radian.
    for (Outline* outline : {&tile.lower, &tile.upper})
      for (glm::dvec2& p : outline->points) p += glm::dvec2(0.5 * random.normal(), 0.5 * random.normal());
    const std::vector<Piece> pieces = pieces_of(tile);
    MultiscaleOptions options;
    options.step = 0.7;
    options.min_length = 20.0;  // lost by the second scale
    options.fitted = 4;
    const auto matcher = make_multiscale(options);
    matcher->prepare(pieces);
    const PairResult result = matcher->match(0, 1, Context());
    ASSERT_FALSE(result.candidates.empty()) << seed;
    EXPECT_LT(worst_distance(result.candidates[0].pose, tile.upper_to_lower, tile.upper), 4.0) << seed;
  }
}

TEST(Multiscale, StrangersGetALowScore) {
  const BrokenTile one = broken_tile(300, 120, {}, 21);
  const BrokenTile other = broken_tile(300, 120, {}, 22);
  const std::vector<Piece> pieces{{"a", "", one.lower}, {"b", "", other.upper}};
  const auto matcher = make_multiscale();
  matcher->prepare(pieces);
  const PairResult result = matcher->match(0, 1, Context());
  for (const JoinCandidate& candidate : result.candidates) EXPECT_LT(candidate.score, 0.5);
}

TEST(Multiscale, StraightSidesAloneAreNoJoin) {
  Outline square;
  testing::add_run(square.points, {0, 0}, {200, 0});
  testing::add_run(square.points, {200, 0}, {200, 200});
  testing::add_run(square.points, {200, 200}, {0, 200});
  testing::add_run(square.points, {0, 200}, {0, 0});
  const std::vector<Piece> pieces{{"a", "", square}, {"b", "", square}};
  const auto matcher = make_multiscale();
  matcher->prepare(pieces);
  const PairResult result = matcher->match(0, 1, Context());
  for (const JoinCandidate& candidate : result.candidates) EXPECT_LT(candidate.score, 0.3);
}

TEST(Multiscale, OneThreadAndManyGiveTheSame) {
  const BrokenTile tile = broken_tile(300, 120, {0.4, {}, false}, 6);
  const std::vector<Piece> pieces = pieces_of(tile);
  std::vector<PairResult> results;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    const auto matcher = make_multiscale();
    matcher->prepare(pieces);
    results.push_back(matcher->match(0, 1, Context()));
  }
  ASSERT_EQ(results[0].candidates.size(), results[1].candidates.size());
  for (std::size_t i = 0; i < results[0].candidates.size(); ++i) {
    EXPECT_EQ(results[0].candidates[i].score, results[1].candidates[i].score);
    EXPECT_EQ(results[0].candidates[i].pose.translation, results[1].candidates[i].pose.translation);
  }
}

TEST(Multiscale, TheOrderOfThePiecesDoesNotMatter) {
  for (std::uint64_t seed = 41; seed <= 43; ++seed) {
    BrokenTile tile = broken_tile(300, 120, {1.3, {500, -200}, false}, seed);
    Random random(seed);
    for (Outline* outline : {&tile.lower, &tile.upper})
      for (glm::dvec2& p : outline->points) p += glm::dvec2(0.3 * random.normal(), 0.3 * random.normal());
    const std::vector<Piece> pieces = pieces_of(tile);
    const auto matcher = make_multiscale();
    matcher->prepare(pieces);
    const auto one = matcher->match(0, 1, Context()).candidates;
    const auto other = matcher->match(1, 0, Context()).candidates;
    ASSERT_FALSE(one.empty());
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].score, other[i].score) << seed;
      EXPECT_LT(worst_distance(one[i].pose, inverse(other[i].pose), tile.upper), 1e-9) << seed;
      EXPECT_EQ(one[i].boundary.length, other[i].boundary.length) << seed;
    }
    // What begins the boundary on one piece ends it on the other.
    const auto place = [&](std::size_t piece, double distance) {
      const std::vector<glm::dvec2>& border = pieces[piece].outline.points;
      return point_at(border, arc_lengths(border), distance);
    };
    const Boundary& first = one[0].boundary;
    EXPECT_LT(glm::distance(place(0, first.begin_a), one[0].pose(place(1, first.begin_b))), 3.0) << seed;
    const Boundary& second = other[0].boundary;
    EXPECT_LT(glm::distance(place(1, second.begin_a), other[0].pose(place(0, second.begin_b))), 3.0) << seed;
    EXPECT_LT(glm::distance(place(0, first.begin_a + first.length), place(0, second.begin_b)), 3.0) << seed;
  }
}

// The unit (here a power of two, which rounds nothing) and the place of the pieces do not matter.
TEST(Multiscale, UnitAndPlaceDoNotMatter) {
  const BrokenTile tile = broken_tile(300, 120, {2.0, {40, 30}, false}, 7);
  std::vector<Piece> pieces = pieces_of(tile);
  const auto matcher = make_multiscale();
  matcher->prepare(pieces);
  const JoinCandidate before = matcher->match(0, 1, Context()).candidates.at(0);
  constexpr double kUnit = 1.0 / 1024.0;
  for (Piece& piece : pieces) {
    for (glm::dvec2& p : piece.outline.points) p *= kUnit;
  }
  matcher->prepare(pieces);
  const JoinCandidate after = matcher->match(0, 1, Context()).candidates.at(0);
  EXPECT_NEAR(after.score, before.score, 1e-6);
  EXPECT_LT(glm::distance(after.pose.translation, before.pose.translation * kUnit), 1e-6);
}

/// A sheet torn across its middle, `length` wide either side, drawn with a point each unit: most of the border is exactly straight.
std::vector<Piece> torn_sheet(double length) {
  constexpr int kHigh = 600;
  Random random(7);
  std::vector<double> waves;
  for (int k = 1; k < kHigh / 6; ++k) waves.push_back(30.0 * std::pow(k, -1.3) * random.normal());
  const auto torn_at = [&](int y) {
    double x = 0.0;
    for (std::size_t k = 0; k < waves.size(); ++k)
      x += waves[k] * std::sin(M_PI * static_cast<double>(k + 1) * y / kHigh);
    return x;
  };
  const auto half = [&](double side) {
    Outline outline;
    for (int y = 0; y <= kHigh; ++y) outline.points.emplace_back(torn_at(y), y);
    const auto wide = static_cast<int>(length);
    for (int x = 1; x <= wide; ++x) outline.points.emplace_back(side * x, kHigh);
    for (int y = kHigh - 1; y >= 0; --y) outline.points.emplace_back(side * length, y);
    for (int x = wide - 1; x >= 1; --x) outline.points.emplace_back(side * x, 0);
    if (signed_area(outline.points) < 0.0) std::reverse(outline.points.begin(), outline.points.end());
    return outline;
  };
  return {{"left", "", half(-1.0)}, {"right", "", half(1.0)}};
}

// The usual turning is that of what bends, however little of the border that is.
TEST(Multiscale, JoinsTornSheetsWhoseOtherSidesAreStraight) {
  for (const double length : {300.0, 900.0}) {
    const std::vector<Piece> pieces = torn_sheet(length);
    const auto matcher = make_multiscale();
    matcher->prepare(pieces);
    const PairResult result = matcher->match(0, 1, Context());
    ASSERT_FALSE(result.candidates.empty()) << length;
    EXPECT_LT(worst_distance(result.candidates[0].pose, Planar{}, pieces[1].outline), 3.0) << length;
    EXPECT_GT(result.candidates[0].score, 0.9) << length;
  }
}

}  // namespace
}  // namespace rejoin::outline
