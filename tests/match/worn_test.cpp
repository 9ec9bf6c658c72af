// Breaks that have lost some of their surface since, each side another part of it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "match/judge.hpp"
#include "match/refine.hpp"
#include "match/verify.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::moved;
using testing::Pair;
using testing::worst_offset;

/// What a break has lost, mm, on average 0.7; the sides differ.
double lost(double x, double y, bool below) {
  const double turn = below ? 0.4 : 1.5;
  const double u = std::cos(turn) * x + std::sin(turn) * y;
  const double v = std::cos(turn) * y - std::sin(turn) * x;
  return 0.7 + 0.3 * std::sin(0.9 * u + turn) + 0.3 * std::sin(0.7 * v) + 0.1 * std::sin(1.3 * (u + v));
}

using Loss = std::function<double(double x, double y, bool below)>;

/// Halves of a block, finely scanned.
Pair pair_with(const Loss& loss) {
  constexpr int kCells = 140;
  Pair pair{testing::planted_pair(5, kCells), {}, {}, {}};
  const auto half = [&](bool below, const Rigid& to_file) {
    mesh::Mesh mesh = testing::half_block(below, kCells);
    for (auto& v : mesh.vertices) {
      if (std::abs(v.z) == static_cast<float>(testing::kHalfZ)) {
        v.z += 0.005F * (std::sin(2.1F * v.x) + std::sin(2.3F * v.y));  // as a good scanner strays
        continue;
      }
      v.z += static_cast<float>((below ? -1.0 : 1.0) * loss(v.x, v.y, below));
    }
    return prepare(below ? "below" : "above", moved(mesh, to_file, {1, 2, 3}), Context{});
  };
  pair.a = half(true, pair.planted.to_a);
  pair.b = half(false, pair.planted.to_b);
  pair.truth = to_origins(pair.a, pair.b, pair.planted.truth);
  return pair;
}

/// Halves of a slab with smooth faces where they broke, like blades struck one after the other; one has 0.12 mm of waves that the other lacks.
Pair smooth_pair() {
  constexpr int kCells = 140;
  constexpr double kStray = 0.03;  // of the scanner, mm
  Pair pair{testing::planted_pair(5, kCells), {}, {}, {}};
  Random random(3);
  const auto half = [&](bool below, const Rigid& to_file) {
    mesh::Mesh mesh = testing::half_block(below, kCells);
    for (auto& v : mesh.vertices) {
      if (std::abs(v.z) != static_cast<float>(testing::kHalfZ))
        v.z = 0.5F * std::sin(0.09F * v.x + 0.4F) * std::cos(0.1F * v.y - 0.3F) +
              (below ? 0.0F : 0.12F * std::sin(0.3F * v.x + 0.25F * v.y));
      v.z += static_cast<float>(kStray * random.normal());
    }
    return prepare(below ? "below" : "above", moved(mesh, to_file, {1, 2, 3}), Context{},
                   mesh::PieceKind::Solid);
  };
  pair.a = half(true, pair.planted.to_a);
  pair.b = half(false, pair.planted.to_b);
  pair.truth = to_origins(pair.a, pair.b, pair.planted.truth);
  return pair;
}

Rigid found_pose(const Pair& pair, const Result& result) {
  return to_origins(pair.a, pair.b, result.candidates.front().pose);
}

TEST(Worn, BreaksOfAFineScanJoinByTheDistancesOfWornOnes) {
  const Pair pair = pair_with(lost);
  ASSERT_TRUE(tell_wear(pair.a, pair.b));
  const Joint fresh(pair.a, pair.b);
  std::vector<Hypothesis> list{{pair.truth, fresh.agreed_evidence(pair.truth), 0.0, -1, -1}};
  refine(list, fresh, passes(fresh.tolerance(), 8).back(), Context{});
  tighten(list, fresh, pair.b, 0.0);
  weigh(list, fresh);
  EXPECT_LT(score_of(list.front().strength), kSure) << "the scan tells the wear";
  const Result result = match(pair.a, pair.b, {}, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_EQ(result.verdict, Verdict::Join) << result.against;
  EXPECT_EQ(result.breaks, Breaks::Worn);
  const double tolerance = contact_tolerance(pair.a, pair.b, Breaks::Worn);
  EXPECT_LT(worst_offset(found_pose(pair, result), pair.truth, pair.b.surface), 2.0 * tolerance)
      << "the gap that was lost, and a tilt of as much";
}

TEST(Worn, FreshBreaksOfAFineScanStayJudgedByTheirOwnDistances) {
  const Pair pair = pair_with([](double, double, bool) { return 0.0; });
  const Result result = match(pair.a, pair.b, {}, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_EQ(result.verdict, Verdict::Join) << result.against;
  EXPECT_EQ(result.breaks, Breaks::Fresh);
  EXPECT_LT(worst_offset(found_pose(pair, result), pair.truth, pair.b.surface), 0.05);
}

TEST(Worn, SparseLooksSayWhatAllSay) {
  const Pair pair = pair_with(lost);
  const Joint joint = Joint(pair.a, pair.b).worn();
  const Joint sparse = joint.sparse();
  const Evidence all = joint.agreed_evidence(pair.truth);
  const Evidence some = sparse.agreed_evidence(pair.truth);
  EXPECT_LT(2 * some.core_samples, all.core_samples) << "else nothing is saved";
  EXPECT_NEAR(some.contact_area / all.contact_area, 1.0, 0.3) << "about a hundred of the samples touch";
  EXPECT_NEAR(some.shared_area / all.shared_area, 1.0, 0.1);
  EXPECT_NEAR(strength(some) / strength(all), 1.0, 0.3);
  const double tolerance = joint.tolerance();
  const Rigid off{axis_rotation(glm::dvec3(0, 0, 1), 0.01), glm::dvec3(0.5 * tolerance)};
  const Rigid aligned =
      sparse.align(off * pair.truth, {.reach_start = 3.0 * tolerance, .reach_end = tolerance});
  EXPECT_LT(worst_offset(aligned, pair.truth, pair.b.surface), 2.0 * tolerance);
}

// Parts of one form that broke alike: one side bends away from the other by more than the scans stray, by less than breaks wear.
TEST(Worn, AlikeBreaksThatAFineScanTellsApartAreNoJoin) {
  const Pair pair = pair_with(
      [](double x, double y, bool below) { return below ? 0.0 : 0.12 * std::sin(0.14 * x + 0.1 * y); });
  ASSERT_TRUE(tell_wear(pair.a, pair.b));
  const Joint worn = Joint(pair.a, pair.b).worn();
  EXPECT_GT(score_of(strength(weigh(worn.agreed_evidence(pair.truth), worn, pair.truth).evidence)), kSure)
      << "the larger distances hide it";
  const Result result = match(pair.a, pair.b, {}, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_EQ(result.verdict, Verdict::Unsure);
  EXPECT_LT(score_of(strength(judge(pair.a, pair.b, pair.planted.truth).evidence)), kSure);
  EXPECT_EQ(result.breaks, Breaks::Fresh);
}

TEST(Worn, SmoothFacesThatLieOnEachOtherAreNotAskedAgain) {
  const Pair pair = smooth_pair();
  const Joint joint(pair.a, pair.b);
  EXPECT_LT(score_of(judge(joint, pair.truth).as_rival), kSure) << "what agrees is large shape alone";
  EXPECT_GT(score_of(strength(judge(joint.worn(), pair.truth).evidence)), kSure)
      << "the larger distances hide it";
  EXPECT_LT(score_of(strength(judge(pair.a, pair.b, pair.planted.truth).evidence)), kSure);
  const Result result = match(pair.a, pair.b, {}, Context{});
  EXPECT_NE(result.verdict, Verdict::Join);
  EXPECT_EQ(result.breaks, Breaks::Fresh);
}

}  // namespace
}  // namespace rejoin::match
