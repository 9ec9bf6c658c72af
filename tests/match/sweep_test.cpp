#include "match/sweep.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::half_block;
using testing::kHalfZ;
using testing::make_pair;

/// Half of a block whose cut is so gentle that it is one facet: a plate.
Fragment gentle_half(bool below) {
  mesh::Mesh half = half_block(below, 64);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) < static_cast<float>(kHalfZ)) v.z *= 0.25F;
  }
  return prepare(below ? "below" : "above", half, Context{});
}

/// Half of a wall 7 mm thick, cut across: a sherd.
Fragment thin_half(bool below) {
  mesh::Mesh half = half_block(below, 64);
  for (auto& v : half.vertices) v.y *= 0.12F;
  return prepare(below ? "below" : "above", half, Context{});
}

double turn_between(const SweepHit& hit, const Rigid& truth) {
  return angle_between(hit.pose, truth) / kDegree;
}

// A plate with pixels to spare gets a first look with larger ones, which must choose the turns next to the true one.
TEST(Sweep, AGentleCutComesFirst) {
  const Fragment a = gentle_half(true);
  const Fragment b = gentle_half(false);
  const SweepResult swept = sweep(a, b, {}, Context{});
  ASSERT_FALSE(swept.hits.empty());
  const SweepHit& best = swept.hits.front();
  const Rigid truth = to_origins(a, b, Rigid{});
  EXPECT_LT(turn_between(best, truth), 4.0);
  const glm::dvec3 middle = mesh::centroid(b.surface);
  EXPECT_LT(glm::distance(best.pose(middle), truth(middle)), 2.0 * best.pitch);
}

// This cut falls into narrow facets, which are looked at at all turns.
TEST(Sweep, AWavyCutComesFirst) {
  const auto pair = make_pair(1);
  const SweepResult swept = sweep(pair.a, pair.b, {}, Context{});
  ASSERT_FALSE(swept.hits.empty());
  EXPECT_LT(turn_between(swept.hits.front(), pair.truth), 4.0);
}

/// Heights of a rough surface, mm.
class Roughness {
 public:
  Roughness(std::uint64_t seed, double share) {
    constexpr int kWaves = 48;
    Random random(seed);
    for (int k = 0; k < kWaves; ++k) {
      const double length = 3.0 * std::exp2(random.uniform(0, 3));
      const double direction = random.uniform(0, 3.14);
      waves_.emplace_back(6.28 / length * std::cos(direction), 6.28 / length * std::sin(direction),
                          random.uniform(0, 6.28), share * length);
    }
  }

  double at(const glm::dvec2& place) const {
    double z = 0.0;
    for (const glm::dvec4& wave : waves_)
      z += wave.w * std::sin(wave.x * place.x + wave.y * place.y + wave.z);
    return z;
  }

 private:
  std::vector<glm::dvec4> waves_;  // along x and y, phase, height
};

/// A part of a block that is broken along a bent and rough surface: 80 mm of it from shift - 40 on.
Fragment bent_part(bool below, float shift, std::uint64_t seed) {
  const Roughness roughness(seed, 0.005);
  mesh::Mesh half = half_block(below, 100);
  for (auto& v : half.vertices) {
    v.x += shift;
    if (std::abs(v.z) == static_cast<float>(kHalfZ)) continue;
    const glm::dvec2 at(v.x, v.y);
    v.z = static_cast<float>(10.0 - glm::dot(at, at) / 200.0 + roughness.at(at));
  }
  return prepare(below ? "below" : "above", half, Context{});
}

/// Half of a block whose break is the other half's up to x = -12; from there on a third piece lay between, as thin as a blade at first.
Fragment half_beside_a_wedge(bool below, std::uint64_t seed) {
  const Roughness shared(seed, 0.004);
  const Roughness own(seed + (below ? 1000 : 2000), 0.004);
  constexpr double kEdge = -12;
  mesh::Mesh half = half_block(below, 100);
  for (auto& v : half.vertices) {
    if (std::abs(v.z) == static_cast<float>(kHalfZ)) continue;
    const glm::dvec2 at(v.x, v.y);
    const double beyond = std::max(0.0, at.x - kEdge);
    const double blend = std::min(1.0, beyond / 4.0);
    const double rise = (below ? -0.12 : 0.12) * beyond;
    v.z = static_cast<float>(rise + (1 - blend) * shared.at(at) + blend * own.at(at));
  }
  return prepare(below ? "below" : "above", half, Context{});
}

// Cracks end at older ones, so two pieces may share a part of their breaks only, here three tenths; and breaks bend, so that one
// bowl lies in another anywhere.
TEST(Sweep, BentBreaksThatShareAPartAreAmongTheFirst) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Fragment a = bent_part(true, -28, seed);
    const Fragment b = bent_part(false, 28, seed);
    const Rigid truth = to_origins(a, b, Rigid{});
    const glm::dvec3 middle = mesh::centroid(b.surface);
    const auto hits = sweep(a, b, {}, Context{}).hits;
    ASSERT_GE(hits.size(), 10U);
    EXPECT_TRUE(std::any_of(hits.begin(), hits.begin() + 10, [&](const SweepHit& hit) {
      return turn_between(hit, truth) < 6.0 && glm::distance(hit.pose(middle), truth(middle)) < 4.0;
    })) << seed;
  }
}

// What two breaks do not share, seen as one with what they share, says that they do not agree.
TEST(Sweep, BreaksThatPartAtAThirdPieceAreAmongTheFirst) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Fragment a = half_beside_a_wedge(true, seed);
    const Fragment b = half_beside_a_wedge(false, seed);
    const Rigid truth = to_origins(a, b, Rigid{});
    const glm::dvec3 middle = mesh::centroid(b.surface);
    const auto hits = sweep(a, b, {}, Context{}).hits;
    ASSERT_FALSE(hits.empty());
    EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [&](const SweepHit& hit) {
      return turn_between(hit, truth) < 6.0 && glm::distance(hit.pose(middle), truth(middle)) < 4.0;
    })) << seed;
  }
}

// A table scanned with one of the pieces: maps of it with pixels that suit the other piece would take gigabytes.
TEST(Sweep, ItsCostHasALimitHoweverUnlikeTheSizesAre) {
  const Fragment small = gentle_half(true);
  const auto evaluations = [&](float times) {
    mesh::Mesh half = half_block(false, 64);
    constexpr std::uint32_t kCells = 40;
    const auto first = static_cast<std::uint32_t>(half.vertices.size());
    const auto at = [&](std::uint32_t i) { return times * (2.0F * static_cast<float>(i) / kCells - 1.0F); };
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      for (std::uint32_t j = 0; j <= kCells; ++j) {
        half.vertices.push_back(static_cast<float>(kHalfZ) * glm::vec3(at(i), at(j), -2));
        if (i == kCells || j == kCells) continue;
        const std::uint32_t v = first + i * (kCells + 1) + j;
        half.faces.emplace_back(v, v + kCells + 1, v + 1);
        half.faces.emplace_back(v + 1, v + kCells + 1, v + kCells + 2);
      }
    }
    SweepOptions largest_facets;
    largest_facets.facets_a = {0};
    largest_facets.facets_b = {0};
    return sweep(small, prepare("large", half, Context{}), largest_facets, Context{}).evaluations;
  };
  EXPECT_LT(evaluations(100), 2 * evaluations(50));
}

TEST(Sweep, NoMorePosesThanAskedForBestFirst) {
  const auto pair = make_pair(5);
  SweepOptions options;
  options.kept.in_all = 7;
  const SweepResult swept = sweep(pair.a, pair.b, options, Context{});
  ASSERT_EQ(swept.hits.size(), 7U);
  for (std::size_t k = 1; k < swept.hits.size(); ++k)
    EXPECT_GE(swept.hits[k - 1].agreement.score, swept.hits[k].agreement.score);
}

TEST(Sweep, SherdsHaveALimitOfTheirOwn) {
  const Fragment a = thin_half(true);
  const Fragment b = thin_half(false);
  ASSERT_TRUE(both_thin(a, b));
  SweepOptions options;
  options.kept.in_all = 3;
  options.kept_thin = {.a_pair_of_facets = 24, .in_all = 7, .of_each = 0};
  EXPECT_EQ(sweep(a, b, options, Context{}).hits.size(), 7U);
}

// The best of all may be of one pair that is no break, as two rims.
TEST(Sweep, SomeOfEveryPairOfFacetsAreKept) {
  const Fragment a = thin_half(true);
  const Fragment b = thin_half(false);
  const auto count = [&](const SweepOptions::Kept& kept) {
    SweepOptions options;
    options.kept_thin = kept;
    std::map<std::pair<int, int>, std::size_t> hits;
    for (const SweepHit& hit : sweep(a, b, options, Context{}).hits) ++hits[{hit.facet_a, hit.facet_b}];
    return hits;
  };
  const auto all = count({.a_pair_of_facets = 24, .in_all = 100000, .of_each = 0});
  const auto few = count({.a_pair_of_facets = 24, .in_all = 1, .of_each = 2});
  ASSERT_GT(all.size(), 1U);
  for (const auto& [facets, hits] : all) EXPECT_EQ(few.at(facets), std::min<std::size_t>(hits, 2));
}

TEST(Prepare, KnowsTheSampleOfEveryFaceThatTheSweepDraws) {
  const Fragment a = thin_half(true);
  EXPECT_EQ(a.sample_of_face, mesh::sample_of_faces(a.facets, a.coarse));
  EXPECT_EQ(a.sample_of_face.size(), a.coarse.faces.size());
}

}  // namespace
}  // namespace rejoin::match
