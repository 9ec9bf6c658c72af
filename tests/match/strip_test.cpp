#include "match/strip.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rejoin::match {
namespace {

constexpr double kRadius = 50.0;
constexpr double kWide = 6.0;
constexpr double kStep = 2.0 * kDegree;

/// A strip from points, its length along x as measured.
FacetPatch strip_of(std::vector<glm::vec3> points) {
  FacetPatch strip;
  glm::vec3 low = points.front();
  glm::vec3 high = points.front();
  for (const auto& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  strip.length = static_cast<double>(high.x - low.x);
  strip.width = static_cast<double>(high.y - low.y);
  strip.area = strip.length * kWide;
  strip.points = std::move(points);
  measure_across(strip);
  return strip;
}

/// The break around a vessel between two angles from the top of a circle, with the middle of its chord along x.
/// \param facing  as the partner has it, seen from its own side
FacetPatch arc(double from_deg, double to_deg, bool facing) {
  const double middle = 0.5 * (from_deg + to_deg) * kDegree;
  std::vector<glm::vec3> points;
  for (double angle = from_deg * kDegree; angle <= to_deg * kDegree; angle += 0.5 * kDegree) {
    for (double across = -0.5 * kWide; across <= 0.5 * kWide; across += 1.0) {
      const double x = (kRadius + across) * std::sin(angle - middle);
      const double y = (kRadius + across) * std::cos(angle - middle);
      points.emplace_back(facing ? -x : x, y, 0.0);
    }
  }
  return strip_of(std::move(points));
}

/// The least distance of a turn from those that are looked at, radians.
double missed_by(const std::vector<double>& turns, double turn) {
  double least = std::numbers::pi;
  for (const double t : turns)
    least = std::min(least, std::abs(std::remainder(t - turn, 2.0 * std::numbers::pi)));
  return least;
}

TEST(Strip, ABentBreakIsAsWideAsAStraightOne) {
  std::vector<glm::vec3> points;
  for (double along = 0.0; along <= 80.0; along += 0.5) {
    for (double across = -0.5 * kWide; across <= 0.5 * kWide; across += 0.5)
      points.emplace_back(along, across, 0.0);
  }
  // A disc three widths across holds 0.98 of what is between its sides; rows at the sides count whole.
  EXPECT_NEAR(strip_of(points).across, kWide, 0.1 * kWide);
  for (const double half : {30.0, 90.0, 170.0}) {
    FacetPatch bent = arc(-half, half, false);
    bent.area = 2.0 * half * kDegree * kRadius * kWide;  // no longer the chord's
    measure_across(bent);
    EXPECT_NEAR(bent.across, kWide, 0.1 * kWide) << half;
  }
}

TEST(Strip, AShortSherdMayJoinAnyPartOfALongBentBreak) {
  const FacetPatch whole = arc(-75, 75, false);
  for (const double at : {-55.0, -30.0, 0.0, 55.0}) {
    const auto turns = turns_along(whole, arc(at - 20, at + 20, true), kStep);
    EXPECT_LE(missed_by(turns, -at * kDegree), kStep) << at;
  }
}

// The turn that lays a hollow break on a bulging one the right way round is half a turn off.
TEST(Strip, BreaksThatAreBentTheOtherWayAreNotLaidAlongEachOther) {
  const auto turns = turns_along(arc(-40, 40, false), arc(-40, 40, true), kStep);
  EXPECT_LE(missed_by(turns, 0.0), kStep);
  EXPECT_GT(missed_by(turns, std::numbers::pi), 60 * kDegree);
}

TEST(Strip, StraightBreaksAreLaidAlongEachOtherEitherWayOnly) {
  std::vector<glm::vec3> points;
  for (double x = -30; x <= 30; x += 0.5) {
    for (double y = -0.5 * kWide; y <= 0.5 * kWide; y += 1.0) points.emplace_back(x, y, 0.0);
  }
  const auto turns = turns_along(strip_of(points), strip_of(points), kStep);
  EXPECT_LE(missed_by(turns, 0.0), kStep);
  EXPECT_LE(missed_by(turns, std::numbers::pi), kStep);
  EXPECT_GT(missed_by(turns, 0.5 * std::numbers::pi), 60 * kDegree);
  EXPECT_TRUE(std::is_sorted(turns.begin(), turns.end()));
}

TEST(Strip, ABreakAllAroundATubeIsAsWideAsItsWall) {
  std::vector<glm::vec3> points;
  for (int degree = 0; degree < 360; ++degree) {
    for (const double radius : {10.0, 11.0, 12.0, 13.0, 14.0})
      points.emplace_back(radius * std::cos(degree * kDegree), radius * std::sin(degree * kDegree), 0.0);
  }
  FacetPatch ring = strip_of(points);
  ring.area = std::numbers::pi * (14.0 * 14.0 - 10.0 * 10.0);
  measure_across(ring);
  EXPECT_NEAR(ring.across, 4.0, 0.6);
}

TEST(Strip, ABreakAllAroundATubeMayLieAnyWay) {
  std::vector<glm::vec3> oval;
  for (int degree = 0; degree < 360; ++degree) {
    for (const double across : {-2.0, -1.0, 0.0, 1.0, 2.0})
      oval.emplace_back((22.0 + across) * std::cos(degree * kDegree),
                        (10.0 + across) * std::sin(degree * kDegree), 0.0);
  }
  FacetPatch ring = strip_of(oval);
  ring.area = 420.0;
  measure_across(ring);
  ASSERT_TRUE(are_strips(ring, ring));
  const auto turns = turns_along(ring, ring, kStep);
  for (int degree = 0; degree < 360; ++degree) EXPECT_LE(missed_by(turns, degree * kDegree), kStep) << degree;
}

}  // namespace
}  // namespace rejoin::match
