#include "outline/turns.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "outline/outline.hpp"
#include "outline/scan.hpp"

namespace rejoin::outline {
namespace {

std::vector<glm::dvec2> circle(double radius, int corners) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * M_PI * i / corners;
    points.push_back(radius * glm::dvec2(std::cos(angle), std::sin(angle)) + glm::dvec2(0.37, 0.11));
  }
  return points;
}

const std::vector<glm::dvec2> kSquare{{0, 0}, {200, 0}, {200, 200}, {0, 200}};

TEST(Turns, CircleTurnsEvenly) {
  const Turns turns = turns_of(circle(100.0, 720), {1.0, 27, 0.1});
  const double each = 360.0 / static_cast<double>(turns.change_deg.size());
  for (const float change : turns.change_deg) EXPECT_NEAR(change, each, 0.01 * each);
}

TEST(Turns, SlopeOfAStraightLineIsItsDirection) {
  const Turns turns = turns_of(kSquare, {1.0, 27, 0.6});
  const std::vector<double> directions = slopes(turns.points, 27);
  EXPECT_NEAR(directions[100], 0.0, 1e-9);
  EXPECT_NEAR(directions[300], M_PI / 2.0, 1e-9);
}

TEST(Turns, OneRoundTurnsByAFullCircle) {
  for (const std::vector<glm::dvec2>& border : {kSquare, circle(60.0, 90)}) {
    double sum = 0.0;
    for (const float change : turns_of(border, {1.0, 27, 0.6}).change_deg) sum += change;
    EXPECT_NEAR(sum, 360.0, 0.01);
  }
}

TEST(Turns, EveryStraightSideOfASquareBecomesOneZero) {
  const Turns turns = turns_of(kSquare, {1.0, 27, 0.6});
  std::size_t zeros = 0;
  for (std::size_t k = 0; k < turns.values.size(); ++k) {
    if (turns.values[k] != 0.0F) {
      EXPECT_GE(turns.values[k], 0.6F);
      EXPECT_EQ(turns.values[k], turns.change_deg[turns.index[k]]);
      continue;
    }
    ++zeros;
    EXPECT_NEAR(turns.index[k], 200.0 * zeros - 100.0, 5.0);  // rounded corners shorten the sides a little
  }
  EXPECT_EQ(zeros, 4U);
}

TEST(Turns, DoNotChangeWhenThePieceIsTurned) {
  const Planar pose{0.7, {31.0, -8.0}, false};
  std::vector<glm::dvec2> turned;
  for (const glm::dvec2& p : kSquare) turned.push_back(pose(p));
  const Turns one = turns_of(kSquare, {1.0, 27, 0.6});
  const Turns other = turns_of(turned, {1.0, 27, 0.6});
  ASSERT_EQ(one.change_deg.size(), other.change_deg.size());
  for (std::size_t i = 0; i < one.change_deg.size(); ++i)
    EXPECT_NEAR(one.change_deg[i], other.change_deg[i], 1e-4);
}

TEST(Turns, ScannedCircleTurnsEvenlyWithinTheStraightCornerMaximum) {
  const Turns turns = turns_of(edge_pixels(circle(150.0, 720)), {1.0, 27, 0.6});
  for (const float change : turns.change_deg) EXPECT_NEAR(change, 360.0 / 942.0, 0.6);
}

TEST(Turns, PlacesAreTheArcLengthsOfTheSamples) {
  const Turns turns = turns_of(kSquare, {1.0, 27, 0.6});
  const std::vector<double> lengths = arc_lengths(kSquare);
  for (std::size_t i = 0; i < turns.points.size(); ++i)
    EXPECT_LT(glm::distance(turns.points[i], point_at(kSquare, lengths, turns.places[i])),
              1.2);  // corners are rounded
}

}  // namespace
}  // namespace rejoin::outline
