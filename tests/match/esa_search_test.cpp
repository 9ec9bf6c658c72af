#include "match/esa_search.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "core/parallel.hpp"
#include "planted_block.hpp"

namespace rejoin::match {
namespace {

Fragment bare_fragment(const mesh::Mesh& mesh, const char* name) {
  Fragment fragment;
  fragment.path = name;
  fragment.surface = mesh;
  fragment.coarse = mesh;
  fragment.diameter = mesh::diameter(mesh);
  return fragment;
}

struct Case {
  testing::PlantedPair pair;
  Fragment a;
  Fragment b;
};

Case planted(std::uint64_t seed) {
  Case c{testing::planted_pair(seed, 16), {}, {}};
  c.a = bare_fragment(c.pair.a, "a");
  c.b = bare_fragment(c.pair.b, "b");
  return c;
}

Options with_directions(const Case& c) {
  Options options;
  options.constraint = Constraint::Direction;
  options.directions_a = {c.pair.direction_a};
  options.directions_b = {c.pair.direction_b};
  options.resolution = 48;
  options.chains = 5;
  options.backend = zbuffer::Backend::Raster;
  return options;
}

bool right(const Case& c, const Rigid& pose) {
  const glm::dvec3 centre = c.b.coarse.origin;
  return angle_between(pose, c.pair.truth) < 5 * kDegree &&
         glm::length(pose(centre) - c.pair.truth(centre)) <
             0.02 * 100;  // 2 % of the block's diagonal, 108 mm
}

TEST(EsaSearch, FindsAPlantedCutAlongGivenDirections) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Case c = planted(seed);
    EsaStats stats;
    const auto found = esa_search(c.a, c.b, with_directions(c), {}, Context(), &stats);
    ASSERT_FALSE(found.empty());
    EXPECT_TRUE(right(c, found[0].pose)) << "seed " << seed;
    EXPECT_EQ(found[0].direction_a, 0);
    EXPECT_GT(stats.evaluations, 1000);
    EXPECT_EQ(stats.convergence.size(), 5U);
    EXPECT_EQ(stats.backend, zbuffer::Backend::Raster);
  }
}

TEST(EsaSearch, FindsPosesInTheCoarsestMapsToo) {
  const Case c = planted(1);
  Options options = with_directions(c);
  options.resolution = 8;
  EXPECT_FALSE(esa_search(c.a, c.b, options, {}, Context()).empty());
}

TEST(EsaSearch, TriesEveryCombinationOfDirections) {
  const Case c = planted(4);
  Options options = with_directions(c);
  options.directions_a.insert(options.directions_a.begin(), -c.pair.direction_a);
  options.directions_b.push_back(-c.pair.direction_b);
  EsaOptions every;
  every.every_chain = true;
  options.chains = 2;
  const auto ends = esa_search(c.a, c.b, options, every, Context());
  ASSERT_EQ(ends.size(), 8U);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    EXPECT_EQ(ends[k].direction_a, static_cast<int>(k / 4));
    EXPECT_EQ(ends[k].direction_b, static_cast<int>(k / 2 % 2));
    EXPECT_EQ(ends[k].chain, static_cast<int>(k % 2));
  }
}

TEST(EsaSearch, HypothesesAreDistinctAndBestFirst) {
  const Case c = planted(1);
  Options options = with_directions(c);
  options.max_candidates = 5;
  const auto found = esa_search(c.a, c.b, options, {}, Context());
  EXPECT_LE(found.size(), 5U);
  const glm::dvec3 centre = c.b.coarse.origin + view_centre(c.b.coarse);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GE(found[i].energy, found[i - 1].energy);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(same_pose(found[i].pose, found[j].pose, centre, std::max(c.a.diameter, c.b.diameter)));
    }
  }
}

TEST(EsaSearch, EveryCombinationHasAPlaceBeforeAnyHasTwo) {
  const Case c = planted(4);
  Options options = with_directions(c);
  options.directions_a.push_back(-c.pair.direction_a);
  options.directions_b.push_back(-c.pair.direction_b);  // flat on flat: no error at any of many poses
  options.max_candidates = 4;
  std::set<std::pair<int, int>> combinations;
  for (const EsaHypothesis& h : esa_search(c.a, c.b, options, {}, Context())) {
    combinations.insert({h.direction_a, h.direction_b});
  }
  EXPECT_EQ(combinations.size(), 4U);
}

TEST(EsaSearch, SameSeedSamePosesForAnyNumberOfThreads) {
  const Case c = planted(2);
  Options options = with_directions(c);
  options.chains = 2;
  const auto one = [&] {
    const ThreadLimit limit(1);
    return esa_search(c.a, c.b, options, {}, Context());
  }();
  const auto many = esa_search(c.a, c.b, options, {}, Context());
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].energy, many[k].energy);
    EXPECT_EQ(one[k].pose.translation, many[k].pose.translation);
  }
}

TEST(EsaSearch, MaterialAxisRestrictsThePosesToCollinearAxes) {
  const Case c = planted(3);
  Options options = with_directions(c);
  options.constraint = Constraint::Material;
  options.directions_a.clear();
  options.directions_b.clear();
  options.chains = 2;
  const glm::dvec3 vein(1, 0, 0);  // of the block, along x
  options.material_a = c.pair.to_a.rotation * vein;
  options.material_b = c.pair.to_b.rotation * vein;
  for (const EsaHypothesis& h : esa_search(c.a, c.b, options, {}, Context())) {
    const double cosine = std::abs(glm::dot(h.pose.rotation * *options.material_b, *options.material_a));
    EXPECT_GT(cosine, std::cos(7.2 * kDegree));  // jitter of 5 degrees about two axes
  }
}

TEST(EsaSearch, WithoutFacetsADirectionSearchSaysSo) {
  const Case c = planted(1);
  Options options = with_directions(c);
  options.directions_a.clear();
  EsaStats stats;
  EXPECT_TRUE(esa_search(c.a, c.b, options, {}, Context(), &stats).empty());
  ASSERT_EQ(stats.warnings.size(), 1U);
  EXPECT_EQ(stats.warnings[0].rfind("a: ", 0), 0U);
}

TEST(EsaSearch, CancelReturnsWhatWasFound) {
  const Case c = planted(1);
  Context context;
  context.cancel();
  EsaStats stats;
  esa_search(c.a, c.b, with_directions(c), {}, context, &stats);
  EXPECT_TRUE(stats.cancelled);
  EXPECT_LE(stats.evaluations, 5);
}

mesh::Facet facet(const glm::dvec3& normal, double area, double roughness, bool fracture) {
  mesh::Facet f;
  f.normal = normal;
  f.area = area;
  f.roughness = roughness;
  f.fracture = fracture;
  return f;
}

TEST(Directions, RoughestFractureFacetsFirstAndCrumbsLeftOut) {
  Fragment fragment;
  fragment.facets.facets = {facet({1, 0, 0}, 100, 0.2, true), facet({0, 1, 0}, 80, 0.5, true),
                            facet({0, 0, 1}, 4, 0.9, true), facet({-1, 0, 0}, 200, 0.8, false)};
  const auto found = candidate_directions(fragment, {}, {}, 4);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].facet, 1);
  EXPECT_EQ(found[1].facet, 0);
  EXPECT_EQ(candidate_directions(fragment, {}, {}, 1).size(), 1U);
  EXPECT_EQ(candidate_directions(fragment, {}, {3}, 4)[0].facet, 3);
  const auto given = candidate_directions(fragment, {{0, 0, 5}}, {}, 4);
  ASSERT_EQ(given.size(), 1U);
  EXPECT_EQ(given[0].facet, -1);
  EXPECT_DOUBLE_EQ(given[0].direction.z, 1);
}

TEST(Directions, OfNamedFacetsAreAllUsed) {
  Fragment fragment;
  fragment.facets.facets = {facet({1, 0, 0}, 100, 0.2, true), facet({0, 1, 0}, 80, 0.5, true),
                            facet({0, 0, 1}, 4, 0.9, true), facet({-1, 0, 0}, 200, 0.8, false)};
  std::vector<int> used;
  for (const CandidateDirection& found : candidate_directions(fragment, {}, {0, 1, 3, 2, 1}, 2))
    used.push_back(found.facet);
  EXPECT_EQ(used, (std::vector<int>{2, 3, 1, 0}));
}

TEST(Directions, WhereNothingIsFractureEveryFacetCounts) {
  Fragment fragment;
  fragment.facets.facets = {facet({1, 0, 0}, 100, 0.2, false), facet({0, 1, 0}, 80, 0.5, false)};
  EXPECT_EQ(candidate_directions(fragment, {}, {}, 4).size(), 2U);
  EXPECT_EQ(facet_towards(fragment, {0.1, 3, 0}), 1);
  EXPECT_EQ(facet_towards(Fragment(), {0, 0, 1}), -1);
}

}  // namespace
}  // namespace rejoin::match
