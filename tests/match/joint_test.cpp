#include "core/angle.hpp"
#include "match/align.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "match/verify.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::flat_half;
using testing::make_pair;
using testing::Pair;
using testing::strength_of_shape;
using testing::worst_offset;

TEST(Evidence, ContactOrdersWeakPosesAndNoStrongOnes) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  const Evidence good = joint.agreed_evidence(pair.truth);
  Evidence flat = good;  // as much contact without shape or skin that goes on
  flat.information = flat.near_information = 0.0;
  flat.continuation = 0.0;
  EXPECT_EQ(strength(flat), 0.0);
  EXPECT_GT(rank(flat), 0.0);
  EXPECT_LT(rank(flat), rank(good));
  Evidence small = flat;
  small.contact_area = small.shared_area = small.near_contact_area = small.near_shared_area =
      2.0 * flat.patch_area;
  small.information = 0.5;  // chance
  EXPECT_GT(strength(small), strength(flat));
  EXPECT_LT(rank(small), rank(flat));
  Evidence gaping = flat;  // half of what lies over it does not touch
  gaping.shared_area = 2.0 * flat.contact_area;
  EXPECT_LT(rank(gaping), 0.1 * rank(flat));
  EXPECT_EQ(rank(Evidence{}), 0.0);
}

// Of a piece 25 times as large as its chip, few samples lie where the chip is.
TEST(Evidence, FewSamplesOfAMuchLargerPieceAreLookedAtWhereTheOtherOneLies) {
  const Fragment chip = prepare("chip", testing::half_block(true, 20, 0.2), Context{});
  const Fragment rest = prepare("rest", testing::half_block(false, 100), Context{});
  const Joint joint(chip, rest);
  const Rigid truth = to_origins(chip, rest, Rigid{});
  const Evidence few = joint.evidence(truth, 300);
  const Evidence all = joint.evidence(truth, 0);
  EXPECT_GT(all.contact_area, 0.04 * 4.0 * testing::kHalfX * testing::kHalfY);  // as it is bent
  EXPECT_NEAR(few.contact_area, all.contact_area, 0.1 * all.contact_area);
  EXPECT_GE(few.core_samples, 12);
}

/// The same pair lying otherwise in its files' axes.
double contact_when_turned(double angle) {
  const Rigid turn{axis_rotation(glm::normalize(glm::dvec3(1.0, 0.2, -0.1)), angle), glm::dvec3(0.0)};
  const Fragment below = prepare("below", testing::moved(testing::half_block(true, 48), turn, {}), Context{});
  const Fragment above =
      prepare("above", testing::moved(testing::half_block(false, 48), turn, {}), Context{});
  return Joint(below, above).evidence(to_origins(below, above, Rigid{}), 0).contact_area;
}

// Surfaces askew to the axes have more samples, of less area each.
TEST(Evidence, ContactAreaIsTheSameHoweverScansLieInTheirAxes) {
  const double straight = contact_when_turned(0.0);
  EXPECT_NEAR(contact_when_turned(0.3), straight, 0.06 * straight);
  EXPECT_NEAR(contact_when_turned(0.785), straight, 0.06 * straight);
}

/// Poses from the truth to where nothing touches, and what evidence at them is worth.
std::vector<Rigid> poses_around(const Rigid& truth) {
  std::vector<Rigid> poses;
  for (int k = 0; k < 12; ++k) {
    const double much = 0.2 * k;
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0 + k % 3, -1.0 + k % 2, 2.0 - k % 5));
    poses.push_back(Rigid{axis_rotation(axis, 0.5 * much * kDegree), much * axis} * truth);
  }
  return poses;
}

/// Asks for evidence that is stronger than limits around its strength.
/// \param above  Joint's function  \param full  its strength
/// \return how often it was told without a look at everything
template <class Above>
int told_early(const Above& above, double full) {
  EXPECT_TRUE(above(full - 1e-3)) << full;
  int early = 0;
  for (const double limit : {full, full + 0.5, full + 2.0, full + 10.0, 100.0}) {
    const auto found = above(limit);
    if (found) {
      EXPECT_EQ(strength(*found), full);
    } else {
      ++early;
    }
  }
  return early;
}

TEST(Joint, EvidenceThatIsNotStrongEnoughIsToldEarlyAndNoOther) {
  const Pair solid = make_pair(6);
  Pair thin = solid;
  thin.a.facets.wall_thickness = thin.b.facets.wall_thickness = 4.0;
  for (const Pair& pair : {std::cref(solid), std::cref(thin)}) {
    const Joint joint(pair.a, pair.b);
    int early = 0;
    int early_agreed = 0;
    for (const Rigid& pose : poses_around(pair.truth)) {
      const LookOptions look{.most_samples = 300, .quick = true};
      early += told_early([&](double limit) { return joint.evidence_above(limit, pose, look); },
                          strength(joint.evidence(pose, 300, -1, true)));
      early_agreed += told_early([&](double limit) { return joint.agreed_evidence_above(limit, pose); },
                                 strength(joint.agreed_evidence(pose)));
    }
    EXPECT_GT(early, 20);
    EXPECT_GT(early_agreed, 15);
  }
}

/// Finely scanned, 50 across.
Fragment solid_piece() {
  Fragment piece;
  piece.diameter = 50.0;
  piece.least_extent = 20.0;
  piece.resolution = 0.1;
  piece.facets.samples.spacing = 0.5;
  return piece;
}

TEST(Joint, TouchesWithinATwentiethOfTheWallOrOfATenthOfASmallSherd) {
  Fragment a = solid_piece();
  a.facets.wall_thickness = 4.0;
  Fragment b = a;
  b.diameter = 80.0;
  EXPECT_DOUBLE_EQ(contact_tolerance(a, b, Breaks::Fresh), 0.05 * 4.0);
  a.facets.wall_thickness = b.facets.wall_thickness = 12.0;
  EXPECT_DOUBLE_EQ(contact_tolerance(a, b, Breaks::Fresh), 0.05 * 0.1 * 50.0);
  b.facets.wall_thickness = 0.0;
  EXPECT_DOUBLE_EQ(contact_tolerance(a, b, Breaks::Fresh), 0.15 * 0.5) << "a sherd and a solid piece";
}

TEST(Joint, WornBreaksOfSolidPiecesTouchWithinAShareOfTheSmallerOne) {
  Fragment a = solid_piece();
  Fragment b = a;
  b.diameter = 80.0;
  EXPECT_DOUBLE_EQ(contact_tolerance(a, b, Breaks::Fresh), 0.15 * 0.5);
  EXPECT_DOUBLE_EQ(contact_tolerance(a, b, Breaks::Worn), 0.0075 * 50.0);
  EXPECT_TRUE(tell_wear(a, b));
  a.resolution = 1.05;  // of a scan as coarse as that both say the same
  EXPECT_DOUBLE_EQ(contact_tolerance(a, b, Breaks::Worn), 0.3 * 1.05);
  EXPECT_FALSE(tell_wear(a, b));
  a.resolution = 0.1;
  a.facets.wall_thickness = 4.0;
  EXPECT_FALSE(tell_wear(a, b)) << "a sherd and a solid piece";
  b.facets.wall_thickness = 4.0;
  EXPECT_FALSE(tell_wear(a, b));
}

TEST(Joint, AlignmentBringsADisturbedPoseBack) {
  const Pair pair = make_pair(9);
  const Joint joint(pair.a, pair.b);
  const Rigid disturbed = Rigid{axis_rotation({0.6, 0, 0.8}, 3.0 * kDegree), {0.8, -0.6, 0.5}} * pair.truth;
  const double tolerance = joint.tolerance();
  const Rigid coarse = joint.align(disturbed, {20.0 * tolerance, 4.0 * tolerance, 20, 0});
  const Rigid fine = joint.align(coarse, {6.0 * tolerance, 3.0 * tolerance, 12, 0});
  // Half a degree at the block's corner is 0.4 mm; the samples lie 1.3 mm apart.
  EXPECT_LT(worst_offset(fine, pair.truth, pair.b.surface), 0.4);
}

TEST(Joint, QuickAlignmentEndsNextToTheExactOne) {
  const Pair pair = make_pair(9);
  const Joint joint(pair.a, pair.b);
  const Rigid disturbed = Rigid{axis_rotation({0.6, 0, 0.8}, 3.0 * kDegree), {0.8, -0.6, 0.5}} * pair.truth;
  const double tolerance = joint.tolerance();
  AlignOptions options{20.0 * tolerance, 4.0 * tolerance, 20, 0};
  const Rigid exact = joint.align(disturbed, options);
  options.quick = true;
  const Rigid quick = joint.align(disturbed, options);
  // What the exact alignment from here on takes off; it starts 3 mm off.
  EXPECT_LT(worst_offset(quick, exact, pair.b.surface), 0.4);
}

TEST(Joint, QuickEvidenceIsNearlyTheExactOne) {
  const Pair pair = make_pair(10);
  const Joint joint(pair.a, pair.b);
  const glm::dvec3 inwards = -pair.planted.direction_a;
  const Evidence exact = joint.evidence(pair.truth, 0);
  const Evidence quick = joint.evidence(pair.truth, 0, -1, true);
  EXPECT_EQ(quick.contact_area, exact.contact_area);
  EXPECT_EQ(quick.information, exact.information);
  EXPECT_LT(quick.penetration_area, 0.01 * exact.contact_area);
  const Rigid pushed = Rigid{glm::dmat3(1.0), 12.0 * joint.tolerance() * inwards} * pair.truth;
  EXPECT_GT(joint.evidence(pushed, 0, -1, true).penetration_area,
            0.8 * joint.evidence(pushed, 0).penetration_area);
}

TEST(Joint, TrueJointHasItsContactAreaAndNoPenetration) {
  const Pair pair = make_pair(10);
  const Joint joint(pair.a, pair.b);
  const Evidence evidence = joint.evidence(pair.truth, 0);
  double cut = 0;  // area of the cut: sum of 1/cos over a fine grid, by differences
  const double step = 0.1;
  for (double x = -testing::kHalfX; x < testing::kHalfX; x += step) {
    for (double y = -testing::kHalfY; y < testing::kHalfY; y += step) {
      const double u = (testing::cut_height(x + step, y) - testing::cut_height(x, y)) / step;
      const double v = (testing::cut_height(x, y + step) - testing::cut_height(x, y)) / step;
      cut += std::sqrt(1 + u * u + v * v) * step * step;
    }
  }
  EXPECT_NEAR(evidence.contact_area, cut, 0.1 * cut);  // samples at the rim have no partner
  EXPECT_LT(evidence.penetration_area, 0.01 * cut);
  EXPECT_LT(evidence.gap_median, 0.5 * joint.tolerance());
}

// The planes meet in a line through the middle: as much is apart as overlaps, so a signed median is 0.
TEST(Joint, GapMedianIsThatOfTheDistanceOnEitherSide) {
  const Fragment below = flat_half(true);
  const Fragment above = flat_half(false);
  const Joint joint(below, above);
  const double farthest = 3.0 * joint.tolerance();  // at the ends in x; all lies within four tolerances
  const double angle = std::asin(farthest / testing::kHalfX);
  const Rigid tilted{axis_rotation({0, 1, 0}, angle), glm::dvec3(0.0)};
  // |gap| is even from 0 to `farthest`; the samples lie a spacing apart, and none beyond the edge.
  EXPECT_NEAR(joint.evidence(tilted, 0).gap_median, 0.5 * farthest, 0.05 * farthest);
  EXPECT_LT(joint.evidence(Rigid{}, 0).gap_median, 0.01 * joint.tolerance());
}

TEST(Joint, WithoutSharedSurfaceThereIsNoGapMedian) {
  const Fragment below = flat_half(true);
  const Fragment above = flat_half(false);
  const Rigid away{glm::dmat3(1.0), {0, 0, 10}};
  const Joint joint(below, above);
  EXPECT_TRUE(std::isinf(unmeasured(below, above, away, joint.evidence(away, 0), 0.0).error.gap_median));
}

TEST(Joint, PushedInPosePenetratesAndIsWeaker) {
  const Pair pair = make_pair(10);
  const Joint joint(pair.a, pair.b);
  const glm::dvec3 inwards = -pair.planted.direction_a;
  const Rigid pushed = Rigid{glm::dmat3(1.0), 12.0 * joint.tolerance() * inwards} * pair.truth;
  const Evidence good = joint.evidence(pair.truth, 0);
  const Evidence bad = joint.evidence(pushed, 0);
  EXPECT_GT(bad.penetration_area, 10.0 * good.penetration_area);
  EXPECT_LT(strength(bad), 0.5 * strength(good));
}

TEST(Joint, FlatSidesInContactGiveNoInformation) {
  // The flat bottom of A against the flat top of B: contact, but nothing to explain.
  const Pair pair = make_pair(11);
  const glm::dmat3 over(1, 0, 0, 0, 1, 0, 0, 0, 1);
  const Rigid b_on_top{over, {0, 0, 2 * testing::kHalfZ}};
  const Rigid flat_contact = Rigid{glm::dmat3(1.0), -pair.planted.a.origin} * pair.planted.to_a *
                             inverse(b_on_top) * inverse(pair.planted.to_b) *
                             Rigid{glm::dmat3(1.0), pair.planted.b.origin};
  const Joint joint(pair.a, pair.b);
  const Evidence flat = joint.evidence(flat_contact, 0);
  EXPECT_GT(flat.contact_area, 0.8 * 4 * testing::kHalfX * testing::kHalfY);
  EXPECT_LT(strength(flat), 0.1 * strength(joint.evidence(pair.truth, 0)));
}

TEST(Joint, FlatSidesWithWornRimsGiveNoInformation) {
  // Flat in the middle, up to 1.3 mm lower within 8 mm of the rim: a quadric must not bend to that and leave relief.
  const auto worn = [](bool below) {
    mesh::Mesh half = testing::half_block(below, 96);
    for (auto& v : half.vertices) {
      if (std::abs(v.z) == static_cast<float>(testing::kHalfZ)) continue;
      const double rim = std::min(testing::kHalfX - std::abs(v.x), testing::kHalfY - std::abs(v.y));
      const double off = 0.02 * std::pow(std::max(0.0, 8.0 - rim), 2.0);
      v.z = static_cast<float>(below ? -off : off);
    }
    return prepare(below ? "below" : "above", half, Context{});
  };
  const Evidence evidence = Joint(worn(true), worn(false)).agreed_evidence(Rigid{});
  EXPECT_GT(evidence.core_samples, 200);
  EXPECT_LT(strength_of_shape(evidence), 1.0);
}

/// Half of a plate 8 mm thick, broken across; from the break on, the upper half leans by an angle, or both
/// do, to one side, and the break is less rough.
Fragment half_plate(bool below, double lean_deg, bool both = false) {
  mesh::Mesh half = testing::half_block(below, 96);
  for (auto& v : half.vertices) {
    const bool far = std::abs(v.z) == static_cast<float>(testing::kHalfZ);
    v.x *= 0.1F;
    const double cut =
        (both ? 0.1 : 0.5) * testing::cut_height(static_cast<double>(v.x), static_cast<double>(v.y));
    const double end = below ? -40.0 : 40.0;
    v.z = static_cast<float>(far ? end : cut);
    const bool leans = !below || both;
    if (far && leans) v.x += static_cast<float>(std::tan(lean_deg * kDegree) * std::abs(end - cut));
  }
  return prepare(below ? "below" : "above", half, Context{});
}

TEST(Joint, WallsGoOnWhereTheyBendAtTheBreakButNotOverAStep) {
  for (const double lean_deg : {0.0, 30.0, 55.0}) {
    const Joint joint(half_plate(true, lean_deg), half_plate(false, lean_deg));
    EXPECT_GT(joint.evidence(Rigid{}, 0).wall_share, 0.6) << lean_deg << " degrees";
    EXPECT_GT(score_of(strength(joint.agreed_evidence(Rigid{}))), 0.99) << lean_deg << " degrees";
    const Rigid step{glm::dmat3(1.0), {4.0, 0.0, 0.0}};
    EXPECT_LT(joint.evidence(step, 0).wall_share, 0.2) << lean_deg << " degrees";
  }
}

// As along the edge of a foot: what is as far behind the seam as another place is before it lies elsewhere.
TEST(Joint, WallsThatMeetAtARightAngleSayNothingAgainstIt) {
  for (const double lean_deg : {38.0, 48.0}) {
    const Fragment below = half_plate(true, lean_deg, true);
    const Fragment above = half_plate(false, lean_deg, true);
    ASSERT_TRUE(both_thin(below, above));
    const Joint joint(below, above);
    EXPECT_GT(score_of(strength(joint.agreed_evidence(Rigid{}))), 0.99) << lean_deg << " degrees";
  }
}

TEST(Joint, SkinGoesOnAcrossTheBorderOfAFlatBreakWhereTheSidesLieInOnePlane) {
  const Fragment below = flat_half(true);
  const Fragment above = flat_half(false);
  const Joint joint(below, above);
  const double patch = std::sqrt(joint.evidence(Rigid{}, 0).patch_area);
  const double width = 1.6 * patch;  // of the strip that is compared
  const auto area = [&](const Rigid& pose) {
    const Evidence evidence = joint.agreed_evidence(pose);
    return evidence.continuation * evidence.patch_area;
  };
  // Corners add to the strip, and the samples that touch end up to a spacing from the border: a quarter of the strip's width.
  const double all = 4.0 * (testing::kHalfX + testing::kHalfY) * width;
  EXPECT_NEAR(area(Rigid{}), all, 0.2 * all);
  // Slid along x only the sides along x go on, where they lie beside each other.
  const double slide = 15.0;
  const double beside = 2.0 * (2.0 * testing::kHalfX - slide) * width;
  EXPECT_NEAR(area({glm::dmat3(1.0), {slide, 0.0, 0.0}}), beside, 0.2 * beside);
  const Rigid turned{axis_rotation({0.0, 0.0, 1.0}, 25.0 * kDegree), glm::dvec3(0.0)};
  EXPECT_LT(area(turned), 0.1 * all);
  // It speaks for the joint, but flat on flat is never more than possible, however much goes on.
  const Evidence flat = joint.agreed_evidence(Rigid{});
  EXPECT_GT(strength(flat), strength_of_shape(flat) + 3.0);
  EXPECT_LT(score_of(strength(flat)), kPossible);
}

TEST(Joint, AgreedStrengthIsTheGeometricMeanOfThatOfBothSides) {
  const Pair pair = make_pair(12);
  const Joint joint(pair.a, pair.b);
  const Joint exchanged(pair.b, pair.a);
  const Rigid shifted = Rigid{glm::dmat3(1.0), {0.2, 0.1, 0.0}} * pair.truth;
  for (const Rigid& pose : {pair.truth, shifted}) {
    const Evidence agreed = joint.agreed_evidence(pose);
    const Evidence there = joint.evidence(pose, 0);
    const Evidence back = exchanged.evidence(inverse(pose), 0);
    const Evidence exchanged_agreed = exchanged.agreed_evidence(inverse(pose));
    const double shape = strength_of_shape(agreed);
    EXPECT_NEAR(shape, std::sqrt(strength_of_shape(there) * strength_of_shape(back)), 1e-9 * shape);
    EXPECT_NEAR(shape, strength_of_shape(exchanged_agreed), 1e-9 * shape);
    EXPECT_DOUBLE_EQ(agreed.continuation, std::min(there.continuation, back.continuation));
    EXPECT_DOUBLE_EQ(agreed.continuation, exchanged_agreed.continuation);
  }
}

/// Half of the planted block whose scan is off by waves of its own, as scans from photographs are.
Fragment wavy_half(bool below, double amplitude) {
  mesh::Mesh half = testing::half_block(below, 96);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) == static_cast<float>(testing::kHalfZ)) continue;
    const float phase = below ? 0.0F : 2.0F;
    v.z += static_cast<float>(amplitude) * std::sin(0.9F * v.x + phase) * std::cos(0.7F * v.y - phase);
  }
  return prepare(below ? "below" : "above", half, Context{});
}

TEST(Joint, ErrorsThatNearPointsShareAreHeardALittleBeyondTheTolerance) {
  const auto evidence_with = [](double amplitude) {
    const Fragment below = wavy_half(true, amplitude);
    const Fragment above = wavy_half(false, amplitude);
    const Evidence agreed = Joint(below, above).agreed_evidence(to_origins(below, above, Rigid{}));
    const Evidence back = Joint(above, below).agreed_evidence(to_origins(above, below, Rigid{}));
    EXPECT_NEAR(strength_of_shape(back), strength_of_shape(agreed), 1e-9 * strength_of_shape(agreed));
    return agreed;
  };
  const auto within_tolerance = [](Evidence evidence) {
    evidence.near_contact_area = 0.0;
    return strength_of_shape(evidence);
  };
  const Evidence exact = evidence_with(0.0);
  EXPECT_EQ(strength_of_shape(exact), within_tolerance(exact));
  const Evidence off = evidence_with(1.6 * exact.tolerance);
  EXPECT_GT(off.gap_spread, off.tolerance);
  EXPECT_GT(strength_of_shape(off), 4.0 * within_tolerance(off));
  EXPECT_LT(strength_of_shape(off), 0.2 * strength_of_shape(exact));
}

TEST(Joint, RoughBreakOnAPlaneSaysNothing) {
  mesh::Mesh plain = testing::half_block(true, 48);
  for (auto& v : plain.vertices) {
    if (v.z > static_cast<float>(-testing::kHalfZ)) v.z = 0.0F;
  }
  mesh::Mesh wavy = testing::half_block(false, 48);
  for (auto& v : wavy.vertices) {
    if (v.z < static_cast<float>(testing::kHalfZ)) v.z *= 0.05F;
  }
  const Fragment plane = prepare("plane", plain, Context{});
  const Fragment waves = prepare("waves", wavy, Context{});
  const Evidence agreed = Joint(plane, waves).agreed_evidence(Rigid{});
  EXPECT_GT(agreed.contact_area, 0.0);
  EXPECT_LE(strength_of_shape(agreed), 0.0);
}

}  // namespace
}  // namespace rejoin::match
