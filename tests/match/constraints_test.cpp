#include "match/constraints.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "match/esa_search.hpp"
#include "planted_block.hpp"

namespace rejoin::match {
namespace {

const glm::dvec3 kAxis(0, 1, 1);

Options with(Constraint constraint, bool directions, bool axes) {
  Options options;
  options.constraint = constraint;
  if (directions) options.directions_a = {{0, 0, 2}};
  if (axes) {
    options.material_a = kAxis;
    options.material_b = kAxis;
  }
  return options;
}

// Axes of both fragments in the common view frame.
std::pair<glm::dvec3, glm::dvec3> axes_of(const zbuffer::ViewPair& view, const glm::dvec3& a,
                                          const glm::dvec3& b) {
  const glm::dvec3 facing = glm::dmat3(view.rotation_b) * b;
  return {glm::dmat3(view.rotation_a) * a, {-facing.x, facing.y, -facing.z}};
}

std::vector<double> random_point(const SearchSpace& space, Random& random) {
  std::vector<double> point;
  for (const anneal::Variable& v : space.variables) point.push_back(random.uniform(v.low, v.high));
  return point;
}

TEST(Constraints, FigureElevensRules) {
  struct Row {
    Constraint constraint;
    bool given_directions, given_axes, directions;
    MaterialUse material;
  };
  using enum MaterialUse;
  for (const Row& row :
       {Row{Constraint::None, false, false, false, None}, Row{Constraint::None, false, true, false, Restrict},
        Row{Constraint::None, true, false, true, None}, Row{Constraint::None, true, true, true, Bias},
        Row{Constraint::Direction, false, false, true, None},
        Row{Constraint::Direction, false, true, true, Bias},
        Row{Constraint::Direction, true, true, true, Bias},
        Row{Constraint::Material, false, true, false, Restrict},
        Row{Constraint::Material, true, true, true, Bias}}) {
    const auto plan = plan_constraints(with(row.constraint, row.given_directions, row.given_axes));
    EXPECT_EQ(plan.directions, row.directions);
    EXPECT_EQ(plan.material, row.material);
  }
}

TEST(Constraints, NamedFacetsGiveDirectionsBesideWhichAxesOnlyBias) {
  Options options = with(Constraint::Material, false, true);
  options.facets_b = {3};
  EXPECT_TRUE(plan_constraints(options).directions);
  EXPECT_EQ(plan_constraints(options).material, MaterialUse::Bias);
}

TEST(Constraints, UnusableOnesAreRefusedByOptionName) {
  const auto message = [](auto change) -> std::string {
    Options options;
    change(options);
    try {
      plan_constraints(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto starts = [](const std::string& text, const std::string& start) {
    return text.rfind(start, 0) == 0;
  };
  EXPECT_TRUE(starts(message([](Options& o) { o.directions_a = {{0, 0, 0}}; }), "--direction-a: "));
  EXPECT_TRUE(starts(message([](Options& o) {
                       o.directions_b = {{0, 0, 1}, {0, 0, 0}};
                     }),
                     "--direction-b: "));
  EXPECT_TRUE(starts(message([](Options& o) { o.material_a = kAxis; }), "--material-b: "));
  EXPECT_TRUE(starts(message([](Options& o) { o.material_b = kAxis; }), "--material-a: "));
  EXPECT_TRUE(
      starts(message([](Options& o) { o.constraint = Constraint::Material; }), "--constraint material: "));
  EXPECT_TRUE(starts(message([](Options& o) { o.tolerance_deg = 46; }), "--tolerance: "));
  EXPECT_TRUE(starts(message([](Options& o) { o.tolerance_deg = std::nan(""); }), "--tolerance: "));
}

TEST(Constraints, FreeSpaceHoldsEveryAngleAndATenthOfTheDiameter) {
  const SearchSpace space = free_space(EsaOptions().shift_range * 200);
  ASSERT_EQ(space.variables.size(), kPoseSize);
  for (const PoseIndex v : {kTheta1, kPhi1, kRho1, kTheta2, kPhi2}) {
    EXPECT_TRUE(space.variables[v].wraps);
    EXPECT_NEAR(space.variables[v].high - space.variables[v].low, 2 * std::numbers::pi, 1e-12);
  }
  for (const PoseIndex v : {kX1, kY1}) {
    EXPECT_FALSE(space.variables[v].wraps);
    EXPECT_DOUBLE_EQ(space.variables[v].low, -20);
    EXPECT_DOUBLE_EQ(space.variables[v].high, 20);
  }
}

TEST(Constraints, DirectionsStayOppositeWithinTheTolerance) {
  const glm::dvec3 a(1, 2, 3);
  const glm::dvec3 b(-2, 0.5, 1);
  const SearchSpace space = direction_space(a, b, 10 * kDegree, 100);
  const std::vector<double> middle = {0, 0, 1.3, 4, 5, 0, 0};
  const auto [facing_a, facing_b] = axes_of(space.view(middle), glm::normalize(a), glm::normalize(b));
  EXPECT_NEAR(glm::dot(facing_a, facing_b), -1, 1e-6);
  Random random(4);
  for (int k = 0; k < 200; ++k) {
    const auto [u, v] =
        axes_of(space.view(random_point(space, random)), glm::normalize(a), glm::normalize(b));
    // Two tilts of up to 10 degrees about perpendicular axes: 14.2 degrees at most for each.
    EXPECT_GT(u.z, std::cos(14.2 * kDegree));
    EXPECT_LT(v.z, -std::cos(14.2 * kDegree));
  }
  EXPECT_LT(direction_space(a, b, 0, 100).variables[kTheta1].high, 0.02 * kDegree);
}

TEST(Constraints, MaterialAxesStayCollinearAtEveryPose) {
  const glm::dvec3 a = glm::normalize(glm::dvec3(1, 2, 3));
  const glm::dvec3 b = glm::normalize(glm::dvec3(-2, 0.5, 1));
  Random random(8);
  for (const bool opposite : {false, true}) {
    const SearchSpace exact = material_space(a, b, 0, 100, opposite);
    const SearchSpace loose = material_space(a, b, 5 * kDegree, 100, opposite);
    double largest = 0;
    for (int k = 0; k < 300; ++k) {
      const auto [u, v] = axes_of(exact.view(random_point(exact, random)), a, b);
      EXPECT_NEAR(glm::dot(u, v), opposite ? -1 : 1, 1e-5);
      const auto [p, q] = axes_of(loose.view(random_point(loose, random)), a, b);
      largest = std::max(largest, std::acos(std::min(1.0, std::abs(glm::dot(p, q)))));
    }
    EXPECT_LT(largest, 7.2 * kDegree);  // two jitters of 5 degrees
    EXPECT_GT(largest, 3.0 * kDegree);
  }
}

TEST(Constraints, TheRelativeRotationAboutTheMaterialAxisIsRho) {
  const glm::dvec3 z(0, 0, 1);
  const SearchSpace space = material_space(z, z, 0, 100, false);
  const Rigid one = pose_of(space.view(std::vector<double>{1, 2, 0.5, 0, 0, 0, 0}), 0, {});
  const Rigid two = pose_of(space.view(std::vector<double>{1, 2, 1.5, 0, 0, 0, 0}), 0, {});
  EXPECT_NEAR(angle_between(one, two), 1.0, 1e-5);
}

TEST(Constraints, ShiftsFollowRhoLinearlyBetweenSamplesAndAcrossTheSeam) {
  SearchSpace space = direction_space({0, 0, 1}, {0, 0, 1}, 0.1, 100);
  space.shift_of_rho = {{0, 0}, {4, 0}, {8, -8}, {12, 4}};
  const auto shift_at = [&](double rho) {
    return space.view(std::vector<double>{0, 0, rho, 1, 2, 0, 0}).shift_a;
  };
  EXPECT_NEAR(shift_at(std::numbers::pi / 4).x, 3, 1e-5);
  EXPECT_NEAR(shift_at(3 * std::numbers::pi / 4).y, -2, 1e-5);
  EXPECT_NEAR(shift_at(7 * std::numbers::pi / 4).x, 7, 1e-5);
  EXPECT_NEAR(shift_at(2 * std::numbers::pi).x, 1, 1e-5);
  EXPECT_NEAR(shift_at(-std::numbers::pi / 4).x, 7, 1e-5);
}

TEST(Constraints, SilhouettesAreCentredToWithinAPixelOfTheTruth) {
  // The halves' silhouettes along the cut's normal are equal rectangles, so the largest overlap is the true
  // shift.
  const auto pair = testing::planted_pair(2, 12);
  zbuffer::ViewOptions view;
  view.view_side = 1.3 * std::max(mesh::diameter(pair.a), mesh::diameter(pair.b));
  view.centre_a = glm::vec3(3, 9, -8);  // deliberately off the middle
  view.centre_b = glm::vec3(view_centre(pair.b));
  const auto scorer = zbuffer::make_scorer(zbuffer::Backend::Raster, pair.a, pair.b, view);
  SearchSpace space = direction_space(pair.direction_a, pair.direction_b, 0.1, 100);
  const int samples = 360;
  centre_on_silhouettes(space, *scorer, view.view_side, samples);
  ASSERT_EQ(space.shift_of_rho.size(), static_cast<std::size_t>(samples));
  const ViewCentres centres{pair.a.origin + glm::dvec3(view.centre_a),
                            pair.b.origin + glm::dvec3(view.centre_b)};
  double nearest = 1e9;
  for (int k = 0; k < samples; ++k) {
    const auto got = space.view(std::vector<double>{0, 0, 2 * std::numbers::pi * k / samples, 0, 0, 0, 0});
    const Rigid pose = pose_of(got, 0, centres);
    if (angle_between(pose, pair.truth) > 1.5 * kDegree) continue;
    const auto wanted = facing_view(pair.truth, pair.direction_a, centres);
    // Both shifts in A's own turned frame: compare where B's centre goes in the plane of the cut.
    const glm::dvec3 difference = pose(centres.b) - pair.truth(centres.b);
    nearest = std::min(nearest,
                       glm::length(difference - glm::dot(difference, pair.direction_a) * pair.direction_a));
    EXPECT_NEAR(glm::length(wanted.view.shift_a), glm::length(got.shift_a), 2.0);
  }
  EXPECT_LT(nearest, 1.5 * view.view_side / view.resolution);
}

zbuffer::PairScore score(float error, int overlap, int a, int b) {
  return {error, overlap, a, b};
}

TEST(Energy, OverlapBiasDividesByTheShareThatOverlaps) {
  EnergyRule rule;
  EXPECT_NEAR(energy(score(0.01F, 500, 1000, 4000), {}, rule), 0.02, 1e-9);
  EXPECT_NEAR(energy(score(0.01F, 1000, 1000, 4000), {}, rule), 0.01, 1e-9);
  rule.overlap_bias = false;
  EXPECT_NEAR(energy(score(0.01F, 500, 1000, 4000), {}, rule), 0.01, 1e-9);
}

TEST(Energy, TooLittleOverlapIsForbidden) {
  const EnergyRule rule;
  EXPECT_TRUE(std::isinf(energy(score(0.0F, 0, 1000, 1000), {}, rule)));
  EXPECT_TRUE(std::isinf(energy(score(0.0F, 49, 1000, 1000), {}, rule)));
  EXPECT_FALSE(std::isinf(energy(score(0.0F, 50, 1000, 1000), {}, rule)));
  EXPECT_TRUE(std::isinf(energy(score(0.0F, 31, 31, 31), {}, rule)));
}

TEST(Energy, CoarseMapsNeedTheSameShareOfPixels) {
  EXPECT_EQ(at_resolution({}, 128).least_pixels, EnergyRule().least_pixels);
  EXPECT_EQ(at_resolution({}, kFineMap).least_pixels, EnergyRule().least_pixels);
  EXPECT_EQ(at_resolution({}, kFineMap / 2).least_pixels, EnergyRule().least_pixels / 4);
}

TEST(Energy, MaterialBiasIsEquationEleven) {
  EnergyRule rule;
  rule.material_weight = 0.4;
  rule.material_axes = {{0, 0, 1}, {0, 0, 1}};
  const auto fit = score(0.01F, 1000, 1000, 1000);
  EXPECT_NEAR(energy(fit, {}, rule), 0.6 * 0.01, 1e-9);  // opposite axes are the same line
  zbuffer::ViewPair tilted;
  tilted.rotation_a = glm::mat3(axis_rotation({1, 0, 0}, std::numbers::pi / 3));
  EXPECT_NEAR(energy(fit, tilted, rule), 0.6 * 0.01 + 0.4 * 0.5, 1e-6);
  rule.material_axes = {{1, 1, 0}, {-1, 1, 0}};  // B's x axis is mirrored when it faces A
  rule.material_axes->first /= std::sqrt(2.0);
  rule.material_axes->second /= std::sqrt(2.0);
  EXPECT_NEAR(energy(fit, {}, rule), 0.6 * 0.01, 1e-9);
}

}  // namespace
}  // namespace rejoin::match
