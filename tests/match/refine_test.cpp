#include "match/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <vector>

#include "core/random.hpp"
#include "match/judge.hpp"
#include "match/verify.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::make_pair;
using testing::Pair;
using testing::worst_offset;

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
  EXPECT_GE(rank(list[0].evidence), rank(list[1].evidence));
}

// Which samples of A are nearest is chance where scans are noisy; by both ones' samples that is less.
TEST(Refine, SettlesNearerToTheTruthThanByEitherOnesSamples) {
  double settled = 0.0;
  double by_b = 0.0;
  double by_a = 0.0;
  for (const std::uint64_t seed : {5U, 6U, 7U, 8U}) {
    Pair pair = make_pair(seed);
    Random random(seed);
    for (mesh::Mesh* scan : {&pair.planted.a, &pair.planted.b}) {
      for (auto& v : scan->vertices) v += 0.1F * glm::vec3(random.normal(), random.normal(), random.normal());
    }
    pair.a = prepare("a", pair.planted.a, Context{});
    pair.b = prepare("b", pair.planted.b, Context{});
    const Joint joint(pair.a, pair.b);
    const Joint from_a(pair.b, pair.a);
    std::vector<Hypothesis> list = moved_from_truth(pair, joint, {0.2});
    const Rigid start = list.front().pose;
    const double t = joint.tolerance();
    const AlignOptions options{2.0 * t, 0.7 * t, 15, 0, true};
    by_b += worst_offset(joint.align(start, options), pair.truth, pair.b.surface);
    by_a += worst_offset(inverse(from_a.align(inverse(start), options)), pair.truth, pair.b.surface);
    settle(list, joint, pair.b, 0.0);
    settled += worst_offset(list.front().pose, pair.truth, pair.b.surface);
  }
  EXPECT_LT(settled, by_b);
  EXPECT_LT(settled, by_a);
}

/// The broken facet of half a block that looks along a direction most.
int facet_along(const Fragment& fragment, const glm::dvec3& direction) {
  const auto& facets = fragment.facets.facets;
  const auto looks = [&](const mesh::Facet& f) { return f.fracture ? glm::dot(f.normal, direction) : -1.0; };
  return static_cast<int>(std::ranges::max_element(facets, {}, looks) - facets.begin());
}

TEST(Refine, FirstRoundsEndAlikeWhicheverPieceMoves) {
  const Fragment large = prepare("large", testing::half_block(true, 96), Context{});
  const Fragment small = prepare("small", testing::half_block(false, 96, 0.35), Context{});
  const int of_large = facet_along(large, {0, 0, 1});
  const int of_small = facet_along(small, {0, 0, -1});
  const Rigid start{axis_rotation(glm::normalize(glm::dvec3(1, 0.5, 0.3)), 4.0 * kDegree), {1.0, 0.5, 0.0}};
  const auto aligned = [&](const Fragment& a, const Fragment& b, int facet_a, int facet_b,
                           const Rigid& from) {
    const Joint joint(a, b);
    std::vector<Hypothesis> list{{to_origins(a, b, from), {}, 0.0, facet_a, facet_b}};
    refine(list, joint, passes(joint.tolerance(), 8).front(), Context{});
    return to_files(a, b, list.front().pose);
  };
  const Rigid there = aligned(large, small, of_large, of_small, start);
  const Rigid back = inverse(aligned(small, large, of_small, of_large, inverse(start)));
  EXPECT_GT(worst_offset(there, start, small.surface), 1.0);
  EXPECT_LT(worst_offset(there, back, small.surface), 0.2);
}

TEST(Refine, WornEdgesDoNotPressTheSurfacesIntoEachOther) {
  Pair pair = make_pair(6);
  const Rigid to_block = inverse(pair.planted.to_b);
  mesh::Mesh worn = pair.planted.b;  // its break recedes all around, by up to 0.6 mm at the edges
  for (auto& v : worn.vertices) {
    const glm::dvec3 p = to_block(worn.origin + glm::dvec3(v));
    const double from_edge = std::min(testing::kHalfX - std::abs(p.x), testing::kHalfY - std::abs(p.y));
    if (p.z >= 0.99 * testing::kHalfZ || from_edge > 6.0) continue;
    v -= glm::vec3(0.1 * (6.0 - from_edge) * pair.planted.direction_b);
  }
  pair.b = prepare("worn", worn, Context{});
  const Joint joint(pair.a, pair.b);
  std::vector<Hypothesis> list = moved_from_truth(pair, joint, {0.2});
  tighten(list, joint, pair.b, 0.0);
  const double before = list.front().strength;
  settle(list, joint, pair.b, 0.0);
  EXPECT_EQ(list.front().strength, before);
  const glm::dvec3 middle = pair.planted.to_b(glm::dvec3(0.0)) - worn.origin;
  const glm::dvec3 error = list.front().pose(middle) - pair.truth(middle);
  // A third of the break recedes, so the median is a little off that of the rest.
  EXPECT_LT(std::abs(glm::dot(error, pair.planted.direction_a)), 0.2 * joint.tolerance());
}

TEST(Refine, PosesThatComeTogetherInTighteningAreOne) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  std::vector<Hypothesis> list = moved_from_truth(pair, joint, {0.3, -0.3});
  const double diameter =
      20.0;  // 2 % of it, within which poses are one, is less than the 0.6 mm between these
  ASSERT_EQ(distinct(list, pair.b, diameter).size(), 2U);
  tighten(list, joint, pair.b, diameter);
  EXPECT_EQ(list.size(), 1U);
}

// One tooth's facet is small against others' flat faces; all teeth together are not.
TEST(Refine, TeethFoundByOneOfThemAreWeighedTogether) {
  const auto toothed = [](bool below) {
    mesh::Mesh half = testing::half_block(below, 96);
    for (auto& v : half.vertices) {
      if (std::abs(v.z) < static_cast<float>(testing::kHalfZ))
        v.z = 8.0F * std::abs(std::remainder(v.x, 20.0F)) / 10.0F + 2.0F * std::sin(0.3F * v.y + 0.1F * v.x);
    }
    return prepare(below ? "below" : "above", half, Context{});
  };
  const Fragment below = toothed(true);
  const Fragment above = toothed(false);
  const Joint joint(below, above);
  const double whole = joint.evidence(Rigid{}, 0).contact_area;
  int tooth = -1;
  for (int f = 0; f < static_cast<int>(above.facets.facets.size()); ++f) {
    const double of_it = joint.evidence(Rigid{}, 0, f).contact_area;
    if (of_it > 0.05 * whole && of_it < 0.3 * whole) tooth = f;
  }
  ASSERT_GE(tooth, 0);
  const auto contact_after = [&](const Pass& pass) {
    std::vector<Hypothesis> list{{Rigid{}, {}, 0.0, 0, tooth}};
    refine(list, joint, pass, Context{});
    return list.front().evidence.contact_area;
  };
  const auto rounds = passes(joint.tolerance(), 8);
  EXPECT_LT(contact_after(rounds[0]), 0.35 * whole);
  EXPECT_GT(contact_after(rounds[1]), 0.9 * whole);
}

/// Poses of one pair of facets, far from each other, each worth less than the one before.
std::vector<Hypothesis> poses_of(int facet_a, int facet_b, int count, const Evidence& evidence,
                                 double first_worth, double aside) {
  std::vector<Hypothesis> list;
  for (int k = 0; k < count; ++k) {
    Hypothesis hypothesis;
    hypothesis.pose.translation = glm::dvec3(1000.0 * k, aside, 0.0);
    hypothesis.evidence = evidence;
    hypothesis.evidence.information = first_worth - k;
    hypothesis.facet_a = facet_a;
    hypothesis.facet_b = facet_b;
    list.push_back(hypothesis);
  }
  return list;
}

TEST(Refine, PosesOfOnePairOfFacetsLeavePlacesToOthers) {
  const Pair pair = make_pair(6);
  const Evidence evidence = Joint(pair.a, pair.b).agreed_evidence(pair.truth);
  std::vector<Hypothesis> list = poses_of(0, 0, 100, evidence, 500.0, 0.0);
  const std::vector<Hypothesis> weaker = poses_of(-1, -1, 2, evidence, 50.0, 5000.0);
  list.insert(list.end(), weaker.begin(), weaker.end());
  const auto kept = shortlist(list, pair.a, pair.b, 16);
  ASSERT_EQ(kept.size(), 16U);
  EXPECT_EQ(std::ranges::count(kept, -1, &Hypothesis::facet_a), 2);
  for (int k = 0; k < 14; ++k)  // the best of the first pair's take what is left
    EXPECT_EQ(kept[static_cast<std::size_t>(k)].evidence.information, 500.0 - k);

  const std::vector<Hypothesis> others = poses_of(-1, -1, 100, evidence, 400.0, 5000.0);
  const std::vector<Hypothesis> more = poses_of(0, -1, 100, evidence, 300.0, -5000.0);
  list = poses_of(0, 0, 100, evidence, 500.0, 0.0);
  list.insert(list.end(), others.begin(), others.end());
  list.insert(list.end(), more.begin(), more.end());
  const auto mixed = shortlist(list, pair.a, pair.b, 18);
  ASSERT_EQ(mixed.size(), 18U);
  for (std::size_t k = 0; k < 18; ++k)  // six of each
    EXPECT_EQ(mixed[k].evidence.information,
              500.0 - 100.0 * static_cast<double>(k / 6) - static_cast<double>(k % 6));
}

// A plate has two sides, of which each lies on either of the other's: four pairs of facets, whose shares are more than there is.
TEST(Refine, FourPairsOfFacetsLeaveAPlaceToAFifth) {
  const Pair pair = make_pair(6);
  ASSERT_GE(pair.a.facets.facets.size(), 2U);
  const Evidence evidence = Joint(pair.a, pair.b).agreed_evidence(pair.truth);
  std::vector<Hypothesis> list;
  for (int k = 0; k < 4; ++k) {
    const auto sides = poses_of(k / 2 - 1, k % 2 - 1, 50, evidence, 500.0 - 0.1 * k, 5000.0 * k);
    list.insert(list.end(), sides.begin(), sides.end());
  }
  std::ranges::sort(list, std::greater(), [](const Hypothesis& h) { return h.evidence.information; });
  const auto join = poses_of(1, 0, 1, evidence, 50.0, -5000.0);
  list.push_back(join.front());
  const auto kept = shortlist(list, pair.a, pair.b, 24);
  ASSERT_EQ(kept.size(), 24U);
  EXPECT_EQ(std::ranges::count(kept, 1, &Hypothesis::facet_a), 1);
  EXPECT_EQ(kept.back().facet_a, 1);
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

/// The planted truth, weighed.
Hypothesis weighed_truth(const Pair& pair, const Joint& joint) {
  std::vector<Hypothesis> list = moved_from_truth(pair, joint, {0.0});
  weigh(list, joint);
  return list.front();
}

TEST(Refine, SmoothBreakThatFitsKeepsItsStrength) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  EXPECT_EQ(weighed_truth(pair, joint).strength, strength(joint.agreed_evidence(pair.truth)));
}

/// Half of a block whose break has a shape of 60 mm and more that both halves share, and a roughness of its own.
/// \param roughness  deviation, mm
Fragment alike_at_large(bool below, double roughness) {
  mesh::Mesh half = testing::half_block(below, 48);
  Random random(below ? 1 : 2);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) >= static_cast<float>(testing::kHalfZ)) continue;
    const auto x = static_cast<double>(v.x);
    const auto y = static_cast<double>(v.y);
    v.z = static_cast<float>(std::sin(0.1 * x + 0.5) * std::cos(0.1 * y) + roughness * random.normal());
  }
  return prepare(below ? "below" : "above", half, Context{});
}

// Large shape agrees over many patches at once, so it says less than shape of a patch's size.
TEST(Refine, ShapeThatAgreesAtLargeAloneIsWorthLess) {
  const Joint joint(alike_at_large(true, 0.12), alike_at_large(false, 0.12));
  Hypothesis hypothesis{Rigid{}, joint.agreed_evidence(Rigid{}), 0.0};
  hypothesis.strength = strength(hypothesis.evidence);
  std::vector<Hypothesis> list{hypothesis};
  weigh(list, joint);
  EXPECT_GT(score_of(hypothesis.strength), kSure);
  EXPECT_LT(list.front().strength, 0.5 * hypothesis.strength);
}

/// What of a scan looks at the other piece.
Fragment scanned_from_the_break(const mesh::Mesh& half, const glm::dvec3& outwards) {
  mesh::Mesh seen = half;
  const auto normals = mesh::face_normals(half);
  seen.faces.clear();
  for (std::size_t f = 0; f < half.faces.size(); ++f) {
    if (glm::dot(glm::dvec3(normals[f]), outwards) > 0.5) seen.faces.push_back(half.faces[f]);
  }
  return prepare("seen", seen, Context{});
}

TEST(Refine, WhatHasNothingBehindItOnEitherSideMayBeWalls) {
  const Pair solid = make_pair(6);
  Pair pair = solid;
  pair.a = scanned_from_the_break(solid.planted.a, solid.planted.direction_a);
  EXPECT_FALSE(may_be_walls(Joint(pair.a, pair.b).agreed_evidence(pair.truth)));
  pair.b = scanned_from_the_break(solid.planted.b, solid.planted.direction_b);
  const Joint joint(pair.a, pair.b);
  ASSERT_GT(score_of(strength(joint.agreed_evidence(pair.truth))), kSure);
  EXPECT_TRUE(may_be_walls(joint.agreed_evidence(pair.truth)));
  EXPECT_LE(weighed_truth(pair, joint).strength, kEven);
}

TEST(Refine, SolidPiecesThatLieLooselyNeedSkinThatGoesOn) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  Evidence evidence = joint.agreed_evidence(pair.truth);
  ASSERT_GT(evidence.continuation, 4.0);
  const auto score = [&] { return score_of(strength(weigh(evidence, joint, pair.truth).evidence)); };
  EXPECT_GT(score(), kSure);
  evidence.shared_area = evidence.contact_area / 0.75;
  EXPECT_GT(score(), kSure);
  evidence.continuation = 1.0;
  EXPECT_LE(score(), 0.5);
  evidence.shared_area =
      evidence.contact_area / 0.95;  // inside an object third pieces lie all around a contact
  EXPECT_GT(score(), kSure);
}

// Ridges lie in grooves at many poses, some just within a limit and some just beyond: what is beyond still shows that the others are chance.
TEST(Refine, WhatIsHeldBackStaysARival) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  Evidence loose = joint.agreed_evidence(pair.truth);
  loose.shared_area = loose.contact_area / 0.8;
  loose.continuation = 1.0;
  std::vector<Hypothesis> list{{pair.truth, loose, strength(loose)}, {pair.truth, loose, strength(loose)}};
  ASSERT_GT(list[1].strength, 2.0 * kEven);
  weigh(list, joint);
  EXPECT_LE(list[1].strength, kEven);
  EXPECT_GT(strongest_rival(list), 2.0 * kEven);
}

// A moulded edge in another's step is no less a contact, but holds no pose.
TEST(Refine, PosesAlongWhichOnePieceSlidesAreEvenAtMost) {
  const Fragment below = testing::grooved_half(true);
  const Fragment above = testing::grooved_half(false);
  const Joint joint(below, above);
  const Evidence evidence = joint.agreed_evidence(Rigid{});
  std::vector<Hypothesis> list{{Rigid{}, evidence, strength(evidence)}};
  list.front().as_rival = list.front().strength;
  probe_likely(list, joint, Context{});
  EXPECT_EQ(list.front().evidence.doubt, Doubt::Slide);
  EXPECT_GT(list.front().as_rival, 2.0 * kEven);
  EXPECT_LE(list.front().strength, kEven);
  const Judged judged = judge(below, above, to_files(below, above, Rigid{}));
  EXPECT_EQ(judged.evidence.doubt, Doubt::Slide);
  EXPECT_LE(strength(judged.evidence), kEven);

  const Pair pair = make_pair(6);
  const Judged held = judge(pair.a, pair.b, pair.planted.truth);
  EXPECT_EQ(held.evidence.doubt, Doubt::None);
  EXPECT_GT(strength(held.evidence), 2.0 * kEven);
}

// Ripples catch a piece that is pushed a little; it fits as well at the next ones.
TEST(Refine, PosesThatFitAsWellFartherAlongAreEvenAtMost) {
  const Fragment below = testing::grooved_half(true, 0.4);
  const Fragment above = testing::grooved_half(false, 0.4);
  const Joint joint(below, above);
  Evidence evidence = joint.agreed_evidence(Rigid{});
  ASSERT_GT(strength(evidence), 2.0 * kEven);
  const Stability stability = hold_sliding(evidence, joint, Rigid{}).value();
  EXPECT_LT(stability.slide, 0.5);
  EXPECT_GT(stability.elsewhere, 0.7);
  EXPECT_EQ(evidence.doubt, Doubt::Slide);
  EXPECT_LE(strength(evidence), kEven);
}

// Run mouldings lie in their likes anywhere; that tells nothing of a break that holds.
TEST(Refine, WhatSlidesIsNoRivalOfWhatHoldsFirmly) {
  const auto rival_beside = [](const Stability& of_best, bool next_slides, double turn_deg) {
    Hypothesis best;
    best.strength = best.as_rival = 30.0;
    best.stability = of_best;
    Hypothesis next = best;
    next.pose.rotation = axis_rotation({0, 0, 1}, turn_deg * kDegree);
    if (next_slides) {
      next.evidence.doubt = Doubt::Slide;
      next.strength = kEven;
    }
    return strongest_rival({best, next});
  };
  EXPECT_EQ(rival_beside({.slide = 0.1}, true, 90.0), kEven);
  EXPECT_EQ(rival_beside({.slide = 0.1}, false, 90.0), 30.0) << "it holds, too";
  EXPECT_EQ(rival_beside({.slide = 0.5}, true, 90.0), 30.0) << "the best holds little better";
  EXPECT_EQ(rival_beside({.elsewhere = 0.4}, true, 90.0), 30.0) << "the best fits elsewhere, too";
  EXPECT_EQ(rival_beside({.slide = 0.1}, true, 1.0), 30.0) << "the same contact farther along";
}

// A large contact of which each patch agrees hardly, as of sawn faces whose marks fit a little somewhere.
TEST(Refine, ManyPatchesThatHardlyAgreeMakeNoSureJoin) {
  const Pair pair = make_pair(6);
  const Joint joint(pair.a, pair.b);
  Evidence evidence = joint.agreed_evidence(pair.truth);
  evidence.patch_area = evidence.shared_area / 400.0;
  const auto weighed = [&](double nats_a_patch) {
    evidence.information = evidence.near_information = 400.0 * nats_a_patch;
    return strength(weigh(evidence, joint, pair.truth).evidence);
  };
  EXPECT_GT(weighed(0.3), 2.0 * kEven);
  EXPECT_LE(weighed(0.1), kEven + 1e-9);
}

}  // namespace
}  // namespace rejoin::match
