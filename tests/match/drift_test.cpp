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

/// As a good scanner's noise.
double ripples(double x, double y) {
  return 0.1 * waves(x, y);
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

TEST(Waviness, IsThatOfRipplesOnSmoothWalls) {
  EXPECT_LT(prepared(part(true, ripples)).waviness, 0.2 * kWave);
}

// As of a model whose hole was filled: errors of the scan are beside it.
TEST(Waviness, IsNotThatOfASmallFilledHole) {
  const auto filled = [](double x, double y) { return x < -25 ? 0.0 : waves(x, y); };
  EXPECT_GT(prepared(part(true, filled)).waviness, 0.6 * kWave);
}

// As of a base that was closed by a plane.
TEST(Waviness, IsNotThatOfAnExactPlane) {
  mesh::Mesh scan = part(true, waves);
  for (glm::vec3& v : scan.vertices)
    if (v.z < -1.85F) v.z = -2.0F;
  EXPECT_GT(prepared(scan).waviness, 0.6 * kWave);
}

// The sum of two waves has the deviation kWave; the robust one of it is a tenth less.
TEST(Waviness, IsTheDeviationOfWaves) {
  const double told = prepared(part(true, waves)).waviness;
  EXPECT_GT(told, 0.7 * kWave);
  EXPECT_LT(told, 1.2 * kWave);
}

TEST(Waviness, IsThatOfThePlacesWithoutDecoration) {
  const auto half_decorated = [](double x, double y) { return y > 0 ? 4.0 * waves(x, y) : ripples(x, y); };
  EXPECT_LT(prepared(part(true, half_decorated)).waviness, 0.3 * kWave);
}

TEST(Waviness, OfSolidPiecesIsThatOfTheirSmoothestSurface) {
  const Fragment part_of = prepared(part(true, waves));
  mesh::Segmentation solid = part_of.facets;
  const double of_walls = part_of.waviness;
  solid.wall_thickness = 0;
  solid.surface.assign(solid.surface.size(), mesh::Surface::Fracture);
  EXPECT_NEAR(waviness(solid, part_of.diameter, part_of.resolution), of_walls, 0.5 * of_walls);
}

TEST(Waviness, IsNotToldWhereNothingIsSurrounded) {
  const Fragment part_of = prepared(part(true, ripples));
  mesh::Segmentation bare = part_of.facets;
  bare.surface.assign(bare.surface.size(), mesh::Surface::Fracture);
  EXPECT_TRUE(std::isinf(waviness(bare, part_of.diameter, part_of.resolution)));
}

double bend(double y, double) {
  return 0.15 * std::sin(0.5 * y);
}

/// What the joint is worth at its place.
double strength_of(const Fragment& a, const Fragment& b) {
  const Joint joint(a, b);
  const Rigid at = to_origins(a, b, Rigid{});
  return strength(weigh(joint.agreed_evidence(at), joint, at).evidence);
}

double drift_of(const Fragment& a, const Fragment& b) {
  return Joint(a, b).scales(to_origins(a, b, Rigid{})).drift;
}

TEST(Drift, IsOneOfSidesOfOneBreak) {
  EXPECT_NEAR(drift_of(prepared(part(true, ripples)), prepared(part(false, ripples))), 1.0, 0.15);
}

TEST(Drift, IsMoreWhereOneSideBendsAwayFromTheOther) {
  EXPECT_GT(drift_of(prepared(part(true, ripples)), prepared(part(false, ripples, bend))), 1.6);
}

// Gaps that drift are alike over several patches, which tell less than as many independent ones.
TEST(Drift, LeavesLessInformation) {
  const auto left = [](double drift) {
    return with_fewer_patches({.information = 40.0, .near_information = 20.0, .drift = drift});
  };
  EXPECT_EQ(left(1.2).information, 40.0) << "as chance has it of one break";
  EXPECT_DOUBLE_EQ(left(2.0).information, 24.0);
  EXPECT_DOUBLE_EQ(left(2.0).near_information, 12.0);
}

// As a scan that is off by 1 % in scale: no sides of two breaks differ so.
TEST(Drift, IsNoneOfScansThatBend) {
  const auto bow = [](double y, double) { return 0.0006 * y * y; };
  EXPECT_LT(drift_of(prepared(part(true, ripples)), prepared(part(false, ripples, bow))), 1.25);
}

TEST(Drift, HoldsAJointBackUnlessTheScansStray) {
  const Fragment smooth = prepared(part(true, ripples));
  const double sides_of_one = strength_of(smooth, prepared(part(false, ripples)));
  const double alike = strength_of(smooth, prepared(part(false, ripples, bend)));
  EXPECT_GT(sides_of_one, 20.0);
  EXPECT_LE(alike, kEven);
  EXPECT_GT(strength_of(prepared(part(true, waves)), prepared(part(false, waves, bend))), kEven + 6.0);
}

/// A pose as the last round of alignment leaves it, weighed.
Hypothesis weighed_at(const Joint& joint, const Rigid& pose) {
  const Evidence evidence = joint.agreed_evidence(pose);
  std::vector<Hypothesis> list{{pose, evidence, strength(evidence), -1, -1}};
  weigh(list, joint);
  return list.front();
}

TEST(Drift, HoldsAPoseBackNoMoreWhereItHasSettled) {
  const Fragment smooth = prepared(part(true, ripples));
  const auto settled = [&](const Fragment& b, double shift) {
    const Joint joint(smooth, b);
    const Rigid shifted{glm::dmat3(1.0), {0.0, shift, 0.0}};  // along the break
    std::vector<Hypothesis> list{weighed_at(joint, to_origins(smooth, b, shifted))};
    EXPECT_EQ(list.front().evidence.doubt, Doubt::Drift) << list.front().evidence.drift;
    EXPECT_LE(list.front().strength, kEven);
    settle(list, joint, b, 0.0);
    EXPECT_LE(list.front().strength, list.front().as_rival);
    return list.front().strength;
  };
  EXPECT_GT(settled(prepared(part(false, ripples)), 0.15), kEven + 6.0);
  EXPECT_LE(settled(prepared(part(false, ripples, bend)), 0.0), kEven) << "these are alike";
}

TEST(Drift, CountsAboveWhatTheScansExplain) {
  const Evidence evidence = told_by_scale({.explained = 0.09}, {.share = 1, .drift = 1.4, .spread = 0.1});
  EXPECT_TRUE(drifts(evidence));
  Evidence other = evidence;
  other.explained = 0.11;
  EXPECT_FALSE(drifts(other));
  EXPECT_FALSE(drifts(told_by_scale(evidence, {.share = 1, .drift = 1.1, .spread = 0.1})));
}

}  // namespace
}  // namespace rejoin::match
