#include "outline/join_fit.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "outline/detail/distance_grid.hpp"
#include "outline/detail/evidence.hpp"
#include "shapes.hpp"

namespace rejoin::outline {
namespace {

constexpr double kLength = 300.0;
constexpr double kHeight = 100.0;

/// Evidence of a tile's two parts at the break, the upper part's side of it waved by `height`.
double evidence_with_wave(double height) {
  testing::BrokenTile tile = testing::broken_tile(kLength, kHeight, {}, 3);
  for (glm::dvec2& p : tile.upper.points) {
    if (p.y < 0.5 * kHeight) p.y += height * std::sin(4.0 * M_PI * p.x / kLength);
  }
  const std::vector<Piece> pieces{{"lower", "", tile.lower}, {"upper", "", tile.upper}};
  const JoinFitter fitter(pieces, {});
  // The lower part's border reaches the break's right end after its lower and right sides; there the upper one's begins.
  const std::vector<double> lengths = arc_lengths(tile.lower.points);
  const auto corner = static_cast<std::size_t>(kLength + kHeight);
  const double line = lengths[corner + static_cast<std::size_t>(kLength)] - lengths[corner];
  const std::vector<PairedPlaces> pairs{{lengths[corner], line}, {lengths[corner] + line, 0.0}};
  const auto fitted = fitter.fit(0, 1, pairs);
  return fitted ? fitted->evidence : 0.0;
}

// A wave of 4 within the tolerance of 8, 150 long: how the borders turn tells it less than how far apart they are.
TEST(JoinFit, ADistanceThatVariesAlongTheBoundarySpeaksAgainstIt) {
  const double exact = evidence_with_wave(0.0);
  EXPECT_GT(exact, 30.0);
  EXPECT_LT(evidence_with_wave(4.0), 0.2 * exact);  // it is 0.18, and 0.41 without that distance
}

/// A circle with points at these places of a pattern of ten degrees, again and again.
Piece circle_with(const std::vector<double>& degrees) {
  Piece piece;
  for (int ten = 0; ten < 36; ++ten) {
    for (const double degree : degrees) {
      const double angle = (10.0 * ten + degree) * M_PI / 180.0;
      piece.outline.points.emplace_back(1000.0 * std::cos(angle), 1000.0 * std::sin(angle));
    }
  }
  return piece;
}

TEST(AutomaticStep, FollowsEvenPointsAndNotThoseOfASimplifiedOutline) {
  const double degree = 1000.0 * M_PI / 180.0;
  EXPECT_NEAR(automatic_step({circle_with({0, 2, 4, 6, 8})}), 1.4 * 2.0 * degree, 0.01 * degree);
  EXPECT_LT(automatic_step({circle_with({0, 0.5, 1, 1.5, 2, 9})}), 0.3 * degree);
  std::vector<double> fine;
  for (int k = 0; k < 50; ++k) fine.push_back(0.2 * k);
  const Piece coarse = circle_with({0, 2, 4, 6, 8});
  EXPECT_NEAR(automatic_step({coarse, coarse, coarse, coarse, coarse, coarse, circle_with(fine), coarse,
                              coarse, coarse, coarse, coarse, coarse, coarse}),
              1.4 * 2.0 * degree, 0.01 * degree)
      << "pieces that are each even";
}

// Overlap is told to a share of the tolerance also in large scans.
TEST(DistanceGrid, IsAsFineAsAskedForHoweverLargeThePiece) {
  for (const double size : {300.0, 1500.0}) {
    const Outline square{{{0, 0}, {size, 0}, {size, size}, {0, size}}, {}, {}};
    const detail::DistanceGrid grid(square, 4.0);
    for (const double depth : {1.0, 5.5, 20.0, 77.0}) {
      EXPECT_NEAR(grid.depth({depth, 0.4 * size}), depth, 4.0) << size;
      EXPECT_NEAR(grid.depth({0.7 * size, size - depth}), depth, 4.0) << size;
    }
    const auto places = static_cast<double>(grid.inside().size());
    EXPECT_NEAR(places * grid.area_of_place(), size * size, 0.03 * size * size);
    EXPECT_LT(places, 10000.0);  // so that looking at all of them costs the same
  }
}

/// Evidence of a border of these turns along itself.
double agreement_of(const std::vector<float>& turning, const detail::Pixels& pixels = {}) {
  const std::size_t count = turning.size();
  ScaleSignal a{1.0, std::vector<glm::dvec2>(count), turning, {}};
  for (std::size_t i = 0; i < count; ++i) a.places.push_back(static_cast<double>(i));
  ScaleSignal b = a;
  for (std::size_t i = 0; i < count; ++i) b.turning[count - 1 - i] = -turning[i];
  const std::vector<ScaleSignal> scales_a{a};
  const std::vector<ScaleSignal> scales_b{b};
  const std::vector<double> limits{10.0};
  const auto perimeter = static_cast<double>(count);
  std::vector<detail::Contact> contacts;
  for (std::size_t i = 0; i < count; ++i)
    contacts.push_back({static_cast<std::int32_t>(i), static_cast<double>(count - 1 - i), 0.0, true});
  return detail::agreement({&scales_a, &limits, {&scales_a[0], perimeter}, pixels},
                           {&scales_b, &limits, {&scales_b[0], perimeter}, pixels}, contacts);
}

TEST(Evidence, OneBendTellsLittleHoweverLongTheStraightLinesBesideIt) {
  std::vector<float> bend(200, 0.0F);
  bend[100] = 1.0F;
  std::vector<float> rough;
  Random random(5);
  for (int i = 0; i < 200; ++i) rough.push_back(static_cast<float>(random.normal()));
  // One sample of 200 carries the bend, and about all carry a rough border.
  EXPECT_LT(agreement_of(bend), 0.05 * agreement_of(rough));
  EXPECT_GT(agreement_of(rough), 100.0);
}

// As perforations and pinking shears leave it: it fits a tooth farther along as well.
TEST(Evidence, ABorderThatRepeatsTellsHardlyAnything) {
  std::vector<float> rough;
  Random random(5);
  for (int i = 0; i < 200; ++i) rough.push_back(static_cast<float>(random.normal()));
  std::vector<float> teeth = rough;
  for (std::size_t i = 10; i < teeth.size(); ++i) teeth[i] = teeth[i - 10];
  EXPECT_LT(agreement_of(teeth), 0.05 * agreement_of(rough));
}

// Pixels bend a straight border by as much; numbers in a file do not.
TEST(Evidence, GentleTurnsTellWhereThereAreNoPixels) {
  std::vector<float> rough;
  Random random(5);
  for (int i = 0; i < 200; ++i) rough.push_back(0.014F * static_cast<float>(random.normal()));
  EXPECT_GT(agreement_of(rough), 100.0);
  EXPECT_EQ(agreement_of(rough, {true, 0.0}), 0.0);
}

}  // namespace
}  // namespace rejoin::outline
