#include "match/match.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/parallel.hpp"
#include "match/align.hpp"
#include "match/refine.hpp"
#include "match/stability.hpp"
#include "match/sweep.hpp"
#include "match/verify.hpp"
#include "planted_block.hpp"

namespace rejoin::match {
namespace {

constexpr double kDegree = 0.017453292519943295;

struct Pair {
  testing::PlantedPair planted;
  Fragment a;
  Fragment b;
  Rigid truth;  ///< relative to the meshes' origins
};

Pair make_pair(std::uint64_t seed) {
  Pair pair{testing::planted_pair(seed), {}, {}, {}};
  const Context context;
  pair.a = prepare("a", pair.planted.a, context);
  pair.b = prepare("b", pair.planted.b, context);
  pair.truth = Rigid{glm::dmat3(1.0), -pair.planted.a.origin} * pair.planted.truth *
               Rigid{glm::dmat3(1.0), pair.planted.b.origin};
  return pair;
}

double worst_offset(const Rigid& pose, const Rigid& truth, const mesh::Mesh& b) {
  double worst = 0;
  for (const auto& v : b.vertices)
    worst = std::max(worst, glm::distance(pose(glm::dvec3(v)), truth(glm::dvec3(v))));
  return worst;
}

TEST(Match, FindsThePlantedCut) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Pair pair = make_pair(seed);
    const Result result = match(pair.a, pair.b, Options{}, Context{});
    ASSERT_FALSE(result.candidates.empty());
    EXPECT_LT(angle_between(result.candidates.front().pose, pair.planted.truth), 1.0 * kDegree)
        << "seed " << seed;
    EXPECT_EQ(result.verdict, Verdict::Join) << "seed " << seed;
    EXPECT_GT(result.evaluations, 1000);
  }
}

/// What the broken surfaces alone are worth.
double strength_of_shape(Evidence evidence) {
  evidence.continuation = 0;
  return strength(evidence);
}

/// Half of a block cut along a plane.
Fragment flat_half(bool below) {
  mesh::Mesh half = testing::half_block(below, 48);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) < static_cast<float>(testing::kHalfZ)) v.z = 0.0F;
  }
  return prepare(below ? "below" : "above", half, Context{});
}

double slide_at(const Joint& joint, const Rigid& pose) {
  return probe(joint, pose, joint.evidence(pose, 0)).value().slide;
}

TEST(Stability, WavyCutHoldsAndPlaneSlides) {
  const Pair pair = make_pair(5);
  EXPECT_LT(slide_at(Joint(pair.a, pair.b), pair.truth), 0.2);
  const Fragment below = flat_half(true);
  const Fragment above = flat_half(false);
  EXPECT_GT(slide_at(Joint(below, above), Rigid{}), 0.8);
}

// A false pose may be carried farther than it was pushed.
TEST(Stability, SlideIsAShare) {
  const Pair pair = make_pair(5);
  const Joint joint(pair.a, pair.b);
  Random random(7);
  for (int k = 0; k < 12; ++k) {
    const Rigid off = testing::random_rigid(random, 8.0 * joint.tolerance());
    const Rigid pose =
        Rigid{axis_rotation({0, 0, 1}, random.uniform(-0.3, 0.3)), off.translation} * pair.truth;
    const auto stability = probe(joint, pose, joint.evidence(pose, 0));
    if (!stability) continue;
    EXPECT_GE(stability->slide, 0.0);
    EXPECT_LE(stability->slide, 1.0);
  }
}

TEST(Stability, PoseWithoutContactIsNotProbedAndNoSureJoin) {
  const Pair pair = make_pair(5);
  const Joint joint(pair.a, pair.b);
  const Rigid apart = Rigid{glm::dmat3(1.0), glm::dvec3(1000, 0, 0)} * pair.truth;
  EXPECT_FALSE(probe(joint, apart, joint.evidence(apart, 0)));
  EXPECT_EQ(verdict_of(1.0, std::nullopt), Verdict::Unsure);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20}), Verdict::Join);
}

/// The planted truth moved by each offset, mm, with its strength; weakest first if the offsets fall.
std::vector<Hypothesis> moved_from_truth(const Pair& pair, const Joint& joint,
                                         std::initializer_list<double> offsets) {
  std::vector<Hypothesis> list;
  for (const double offset : offsets) {
    Hypothesis hypothesis;
    hypothesis.pose = Rigid{glm::dmat3(1.0), glm::dvec3(offset, 0, 0)} * pair.truth;
    hypothesis.evidence = joint.agreed_evidence(hypothesis.pose);
    hypothesis.strength = strength(hypothesis.evidence);
    list.push_back(hypothesis);
  }
  return list;
}

TEST(Refine, TighteningNeverWeakensAndSorts) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  std::vector<Hypothesis> list = moved_from_truth(pair, joint, {1.0, 0.5});
  ASSERT_LT(list[0].strength, list[1].strength);
  const double strongest = list[1].strength;
  tighten(list, joint, pair.b, 0.0);  // by this diameter no two poses are one
  ASSERT_EQ(list.size(), 2U);
  EXPECT_GE(list[0].strength, strongest);
  EXPECT_GE(list[0].strength, list[1].strength);
  for (const Hypothesis& hypothesis : list)
    EXPECT_LE(hypothesis.strength, strength(joint.agreed_evidence(hypothesis.pose)));
}

TEST(Refine, TighteningGoesOnWhereAlignmentEnds) {
  Pair pair = make_pair(6);
  mesh::Mesh worn = pair.planted.b;  // nearly half of the break recedes, more and more
  for (auto& v : worn.vertices) {
    const glm::dvec3 p = pair.truth(glm::dvec3(v));
    if (std::abs(p.z) >= 0.9 * testing::kHalfZ || p.x < 2.0) continue;
    v += glm::vec3(glm::transpose(pair.truth.rotation) * glm::dvec3(0, 0, 0.1 * (p.x - 2.0)));
  }
  pair.b = prepare("worn", worn, Context{});
  const Joint joint(pair.a, pair.b);
  const std::vector<Hypothesis> start = moved_from_truth(pair, joint, {0.4});
  std::vector<Hypothesis> list = start;
  tighten(list, joint, pair.b, 0.0);
  const double settled = strength(joint.agreed_evidence(list.front().pose));
  EXPECT_LT(list.front().strength, settled);  // which does not count: small steps gain at false poses, too
  const double t = joint.tolerance();
  for (const double reach : {1.0, 0.7, 0.5, 0.35}) {
    const Rigid aligned = joint.align(start.front().pose, {1.0 * t, reach * t, 15, 0, true});
    EXPECT_GT(settled, strength(joint.agreed_evidence(aligned))) << reach;
  }
}

TEST(Refine, PosesThatComeTogetherInTighteningAreOne) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  std::vector<Hypothesis> list = moved_from_truth(pair, joint, {0.3, -0.3});
  const double diameter =
      20.0;  // 2 % of it, within which poses are one, is less than the 0.6 mm between these
  ASSERT_EQ(distinct(list, pair.b, diameter, 2).size(), 2U);
  tighten(list, joint, pair.b, diameter);
  EXPECT_EQ(list.size(), 1U);
}

TEST(Refine, MovesWhatGainsAndLeavesWhatWouldWeaken) {
  const Pair pair = make_pair(5);
  const Joint joint(pair.a, pair.b);
  const Pass last = passes(joint.tolerance(), 8).back();
  Rigid best = pair.truth;
  for (int round = 0; round < 5; ++round) best = joint.align(best, last.align);
  Pass harmful = last;  // reaches too far over too few samples
  harmful.align.reach_start = harmful.align.reach_end = 40.0 * joint.tolerance();
  harmful.align.most_samples = 40;
  harmful.align.core_only = false;
  const auto worth = [&](const Rigid& pose) { return strength(joint.agreed_evidence(pose)); };
  ASSERT_LT(worth(joint.align(best, harmful.align)), worth(best));
  std::vector<Hypothesis> list{{best, {}, 0.0}};
  refine(list, joint, harmful, Context{});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(worst_offset(list.front().pose, best, pair.b.surface), 0.0);
  EXPECT_EQ(list.front().strength, worth(best));

  Rigid disturbed = best;
  disturbed.translation += glm::dvec3(0.4 * joint.tolerance());
  list = {{disturbed, {}, 0.0}};
  refine(list, joint, last, Context{});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_GT(list.front().strength, worth(disturbed));
}

TEST(Evidence, ContactOrdersWeakPosesAndNoStrongOnes) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  const Evidence good = joint.agreed_evidence(pair.truth);
  Evidence flat = good;  // as much contact without shape or skin that goes on
  flat.information = 0.0;
  flat.continuation = 0.0;
  EXPECT_EQ(strength(flat), 0.0);
  EXPECT_GT(rank(flat), 0.0);
  EXPECT_LT(rank(flat), rank(good));
  Evidence small = flat;
  small.contact_area = small.shared_area = 2.0 * flat.patch_area;
  small.information = 0.5;  // chance
  EXPECT_GT(strength(small), strength(flat));
  EXPECT_LT(rank(small), rank(flat));
  Evidence gaping = flat;  // half of what lies over it does not touch
  gaping.shared_area = 2.0 * flat.contact_area;
  EXPECT_LT(rank(gaping), 0.1 * rank(flat));
  EXPECT_EQ(rank(Evidence{}), 0.0);
}

TEST(Match, PlainBlockDoesNotJoin) {
  // Flat sides of equal size everywhere, nothing that fits the cut: the paper's trivial solutions must not count.
  const Pair pair = make_pair(4);
  mesh::Mesh plain = testing::half_block(false, 48);
  for (auto& v : plain.vertices) {
    if (v.z < static_cast<float>(testing::kHalfZ)) v.z = -10.0F;
  }
  const Fragment other = prepare("plain", plain, Context{});
  const Result result = match(pair.a, other, Options{}, Context{});
  EXPECT_EQ(result.verdict, Verdict::NoJoin);
}

/// A scan of one half of a block by a scanner that puts every point off by 0.35 mm along every axis.
Fragment noisy_half(mesh::Mesh half, std::uint64_t seed) {
  Random random(seed);
  for (auto& v : half.vertices) {
    v += glm::vec3(0.35 * glm::dvec3(random.normal(), random.normal(), random.normal()));
  }
  return prepare("noisy " + std::to_string(seed), std::move(half), Context{});
}

TEST(Match, NoisyScansJoinWhereTheirBreaksFitAsWellAsNoiseLetsThem) {
  const auto planted = testing::planted_pair(7, 96);
  const Fragment a = noisy_half(planted.a, 1);
  const Fragment b = noisy_half(planted.b, 2);
  ASSERT_LT(0.3 * a.resolution, 0.35);  // what the spacing of the points alone would let touch
  const Result result = match(a, b, Options{}, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_LT(angle_between(result.candidates.front().pose, planted.truth), 1.0 * kDegree);
  EXPECT_EQ(result.verdict, Verdict::Join);
}

TEST(Match, NoiseIsNoReliefToAgreeOn) {
  mesh::Mesh flat = testing::half_block(false, 96);
  for (auto& v : flat.vertices) {
    if (v.z < static_cast<float>(testing::kHalfZ)) v.z = -10.0F;
  }
  const Fragment a = noisy_half(flat, 3);
  const Fragment b = noisy_half(flat, 4);
  EXPECT_EQ(match(a, b, Options{}, Context{}).verdict, Verdict::NoJoin);
}

TEST(Match, ThreadsDoNotChangeTheResult) {
  const Pair pair = make_pair(6);
  std::vector<Result> results;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    results.push_back(match(pair.a, pair.b, Options{}, Context{}));
  }
  ASSERT_EQ(results[0].candidates.size(), results[1].candidates.size());
  for (std::size_t k = 0; k < results[0].candidates.size(); ++k) {
    EXPECT_EQ(results[0].candidates[k].score, results[1].candidates[k].score);
    EXPECT_EQ(results[0].candidates[k].pose.translation, results[1].candidates[k].pose.translation);
  }
}

TEST(Match, AsksForDirectionsAndLooksNowhereElse) {
  const Pair pair = make_pair(7);
  Options options;
  options.constraint = Constraint::Direction;
  options.directions_a = {pair.planted.direction_a};
  options.directions_b = {pair.planted.direction_b};
  const Result narrow = match(pair.a, pair.b, options, Context{});
  const Result wide = match(pair.a, pair.b, Options{}, Context{});
  ASSERT_FALSE(narrow.candidates.empty());
  EXPECT_LT(angle_between(narrow.candidates.front().pose, pair.planted.truth), 1.0 * kDegree);
  EXPECT_LT(narrow.evaluations, wide.evaluations);
}

TEST(Match, CancelledSearchReturnsAtOnceAndSaysSo) {
  const Pair pair = make_pair(8);
  Context context;
  context.cancel();
  const Result result = match(pair.a, pair.b, Options{}, context);
  EXPECT_TRUE(result.cancelled);
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

/// Half of a plate 8 mm thick, broken across; from the break on, the upper half leans by an angle.
Fragment half_plate(bool below, double lean_deg) {
  mesh::Mesh half = testing::half_block(below, 96);
  for (auto& v : half.vertices) {
    const bool far = std::abs(v.z) == static_cast<float>(testing::kHalfZ);
    v.x *= 0.1F;
    const double cut = 0.5 * testing::cut_height(static_cast<double>(v.x), static_cast<double>(v.y));
    const double end = below ? -40.0 : 40.0;
    v.z = static_cast<float>(far ? end : cut);
    if (far && !below) v.x += static_cast<float>(std::tan(lean_deg * kDegree) * (end - cut));
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

TEST(Score, PoseThatAnotherComesNearOrThatTurnsIsNoSureJoin) {
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20, .repeat_deg = 0.5}), Verdict::Join);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 8, .repeat_deg = 0.5}), Verdict::Unsure);
  EXPECT_EQ(verdict_of(1.0, Stability{.margin = 20, .repeat_deg = 4}), Verdict::Unsure);
  EXPECT_EQ(verdict_of(0.1, Stability{.margin = 20, .repeat_deg = 0.5}), Verdict::NoJoin);
}

TEST(Score, GrowsWithStrengthBetweenZeroAndOne) {
  EXPECT_LT(score_of(-50.0), 0.01);
  EXPECT_GT(score_of(200.0), 0.99);
  for (double s = -20; s < 60; s += 1) EXPECT_LE(score_of(s), score_of(s + 1));
}

}  // namespace
}  // namespace rejoin::match
