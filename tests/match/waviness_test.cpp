/// Plates broken across, with smooth and with wavy walls.
#include "match/waviness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "match/align.hpp"
#include "match/match.hpp"
#include "match/refine.hpp"
#include "match/verify.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::match {
namespace {

constexpr glm::dvec3 kHalf{30, 24, 2};
constexpr double kWave = 0.05;  // mm, amplitude along either axis

using Height = std::function<double(double, double)>;

double flat(double, double) {
  return 0.0;
}
double waves(double x, double y) {
  return kWave * (std::sin(2.1 * x) + std::sin(2.3 * y));
}

double broken_at(double y) {
  return 1.5 * std::sin(0.21 * y) + 0.8 * std::sin(0.55 * y + 1.0) + 0.4 * std::sin(1.3 * y + 0.4);
}

/// A part of a plate 4 thick that is broken across.
/// \param wall  height of both walls above flat ones
/// \param off  by how much the break lies beside broken_at()
mesh::Mesh part(bool left, const Height& wall, const Height& off = flat) {
  const shatter::Grid grid{.size = 2.4 * kHalf.x, .spacing = 0.4};
  return shatter::surface_nets(
      [&](const glm::dvec3& p) {
        const glm::dvec3 outside = glm::abs(p) - kHalf;
        const double side = p.x - broken_at(p.y) - off(p.y, p.z);
        return std::max({outside.x, outside.y, outside.z - wall(p.x, p.y), left ? side : -side});
      },
      grid, Context{});
}

Fragment prepared(const mesh::Mesh& scan) {
  return prepare("part", scan, Context{});
}

TEST(Waviness, IsNextToNothingOnSmoothWalls) {
  EXPECT_LT(prepared(part(true, flat)).waviness, 0.1 * kWave);
}

// The sum of two waves has the deviation kWave; the robust one of it is a tenth less.
TEST(Waviness, IsTheDeviationOfWaves) {
  const double told = prepared(part(true, waves)).waviness;
  EXPECT_GT(told, 0.7 * kWave);
  EXPECT_LT(told, 1.2 * kWave);
}

TEST(Waviness, IsThatOfThePlacesWithoutDecoration) {
  const auto half_decorated = [](double x, double y) { return y > 0 ? 4.0 * waves(x, y) : 0.0; };
  EXPECT_LT(prepared(part(true, half_decorated)).waviness, 0.2 * kWave);
}

TEST(Waviness, OfSolidPiecesIsThatOfTheirSmoothestSurface) {
  mesh::Segmentation solid = prepared(part(true, waves)).facets;
  const double of_walls = waviness(solid);
  solid.wall_thickness = 0;
  solid.surface.assign(solid.surface.size(), mesh::Surface::Fracture);
  EXPECT_NEAR(waviness(solid), of_walls, 0.5 * of_walls);
}

TEST(Waviness, IsNotToldWhereNothingIsSurrounded) {
  mesh::Segmentation bare = prepared(part(true, flat)).facets;
  bare.surface.assign(bare.surface.size(), mesh::Surface::Fracture);
  EXPECT_TRUE(std::isinf(waviness(bare)));
}

double bend(double y, double) {
  return 0.15 * std::sin(0.5 * y);
}

/// What the joint is worth at its place.
double strength_of(const Fragment& a, const Fragment& b) {
  const Joint joint(a, b);
  const Rigid at = to_origins(a, b, Rigid{});
  return strength(weigh(joint.agreed_evidence(at), joint, at));
}

double drift_of(const Fragment& a, const Fragment& b) {
  return Joint(a, b).scales(to_origins(a, b, Rigid{})).drift;
}

TEST(Drift, IsOneOfSidesOfOneBreak) {
  EXPECT_NEAR(drift_of(prepared(part(true, flat)), prepared(part(false, flat))), 1.0, 0.15);
}

TEST(Drift, IsMoreWhereOneSideBendsAwayFromTheOther) {
  EXPECT_GT(drift_of(prepared(part(true, flat)), prepared(part(false, flat, bend))), 1.6);
}

TEST(Drift, HoldsAJointBackUnlessTheScansStray) {
  const Fragment smooth = prepared(part(true, flat));
  const double sides_of_one = strength_of(smooth, prepared(part(false, flat)));
  const double alike = strength_of(smooth, prepared(part(false, flat, bend)));
  EXPECT_GT(sides_of_one, 20.0);
  EXPECT_LE(alike, kEven);
  EXPECT_GT(strength_of(prepared(part(true, waves)), prepared(part(false, waves, bend))), kEven + 6.0);
}

TEST(Drift, CountsAboveWhatTheScansExplain) {
  const Evidence evidence = told_by_scale({.gap_spread = 0.1, .explained = 0.09}, {.share = 1, .drift = 1.4});
  EXPECT_TRUE(drifts(evidence));
  Evidence other = evidence;
  other.explained = 0.11;
  EXPECT_FALSE(drifts(other));
  EXPECT_FALSE(drifts(told_by_scale(evidence, {.share = 1, .drift = 1.1})));
}

}  // namespace
}  // namespace rejoin::match
