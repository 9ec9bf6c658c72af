#include "zbuffer/scorer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "shapes.hpp"

namespace rejoin::zbuffer {
namespace {

TEST(MakeScorer, ResolutionOutOfRangeThrows) {
  const mesh::Mesh sphere = test::icosphere(1, 1);
  for (const int resolution : {-1, 0, 7, 2049}) {
    EXPECT_THROW(make_scorer(Backend::Raster, sphere, sphere, {.resolution = resolution}), InputError);
  }
  EXPECT_NO_THROW(make_scorer(Backend::Raster, sphere, sphere, {.resolution = 8}));
  EXPECT_NO_THROW(make_scorer(Backend::Raster, sphere, sphere, {.resolution = 2048}));
}

TEST(MakeScorer, MeshWithoutFacesThrows) {
  const mesh::Mesh sphere = test::icosphere(1, 1);
  mesh::Mesh cloud = sphere;
  cloud.faces.clear();
  EXPECT_THROW(make_scorer(Backend::Auto, cloud, sphere, {}), InputError);
  EXPECT_THROW(make_scorer(Backend::Auto, sphere, cloud, {}), InputError);
}

TEST(MakeScorer, ViewSideThatIsNotFiniteThrows) {
  const mesh::Mesh sphere = test::icosphere(1, 1);
  EXPECT_THROW(make_scorer(Backend::Raster, sphere, sphere, {.view_side = std::nan("")}), InputError);
  EXPECT_THROW(make_scorer(Backend::Raster, sphere, sphere, {.view_side = HUGE_VAL}), InputError);
}

TEST(MakeScorer, AutoTakesABackendThatIsListedAsAvailable) {
  const mesh::Mesh sphere = test::icosphere(1, 1);
  const auto scorer = make_scorer(Backend::Auto, sphere, sphere, {.resolution = 16});
  EXPECT_NE(scorer->backend(), Backend::Auto);
  bool listed = false;
  for (const BackendInfo& info : list_backends()) {
    listed = listed || (info.backend == scorer->backend() && info.available);
    EXPECT_EQ(info.available, info.why_not.empty()) << name_of(info.backend);
    EXPECT_EQ(info.available, !info.renderer.empty()) << name_of(info.backend);
  }
  EXPECT_TRUE(listed);
}

TEST(MakeScorer, DefaultViewIsThirteenTenthsOfTheLargerDiameter) {
  const mesh::Mesh large = test::icosphere(1.0F, 4);
  const mesh::Mesh small = test::icosphere(0.25F, 3);
  const int n = 260;
  const auto maps = make_scorer(Backend::Raster, small, large, {.resolution = n})->depth_maps({});
  int across_large = 0;
  int across_small = 0;
  for (int i = 0; i < n; ++i) {
    across_large += std::isnan(maps.second.at(i, n / 2)) ? 0 : 1;
    across_small += std::isnan(maps.first.at(i, n / 2)) ? 0 : 1;
  }
  EXPECT_NEAR(across_large, n / 1.3, 3);  // the diameter is known to 1 %, the silhouette to a pixel
  EXPECT_NEAR(across_small, n / 1.3 / 4, 2);
}

/// Every corner case of the fast path in one mesh: tiny, large, edge-on, off the map, not finite.
mesh::Mesh mixed_soup(std::uint64_t seed) {
  Random random(seed);
  mesh::Mesh soup;
  for (int f = 0; f < 300; ++f) {
    const double size = std::pow(10.0, random.uniform(-3, 0.7));
    const glm::vec3 at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto first = static_cast<unsigned>(soup.vertices.size());
    for (int k = 0; k < 3; ++k) {
      soup.vertices.push_back(
          at + glm::vec3(random.normal() * size, random.normal() * size, random.normal() * size));
    }
    if (f % 50 == 0) soup.vertices.back() = soup.vertices[first];
    if (f % 70 == 0) soup.vertices.back().y = std::numeric_limits<float>::quiet_NaN();
    soup.faces.emplace_back(first, first + 1, first + 2);
  }
  return soup;
}

TEST(RasterScorer, CoversExactlyWhatTheReferenceCovers) {
  for (const int resolution : {8, 33, 64, 100}) {
    const mesh::Mesh a = mixed_soup(1);
    const mesh::Mesh b = test::bumpy_sphere(3, 2);
    const ViewOptions options{.resolution = resolution, .view_side = 2.6};
    const auto raster = make_scorer(Backend::Raster, a, b, options);
    const auto reference = make_scorer(Backend::Reference, a, b, options);
    for (const ViewPair& pose : test::random_poses(4, 11)) {
      const auto fast = raster->depth_maps(pose);
      const auto slow = reference->depth_maps(pose);
      for (const auto& [x, y] :
           {std::pair{&fast.first, &slow.first}, std::pair{&fast.second, &slow.second}}) {
        for (std::size_t k = 0; k < x->depth.size(); ++k) {
          ASSERT_EQ(std::isnan(x->depth[k]), std::isnan(y->depth[k]))
              << "pixel " << k << " of " << resolution;
          // Weights are exact integers over the area, so only the last bits of depths up to 20 differ.
          if (!std::isnan(y->depth[k])) {
            ASSERT_NEAR(x->depth[k], y->depth[k], 2e-5F) << "pixel " << k;
          }
        }
      }
    }
  }
}

TEST(Scorers, APoseThatIsNotFiniteShowsNothing) {
  const mesh::Mesh sphere = test::icosphere(1, 2);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (const Backend backend : {Backend::Raster, Backend::RayCast, Backend::Reference}) {
      const ViewPair pose{.rotation_a = glm::mat3(bad), .shift_a = {bad, 0.0F}};
      PairScore score;
      make_scorer(backend, sphere, sphere, {.resolution = 32})->score({&pose, 1}, {&score, 1});
      EXPECT_EQ(score.covered_a, 0) << name_of(backend);
      EXPECT_EQ(score.overlap, 0) << name_of(backend);
      EXPECT_GT(score.covered_b, 100) << name_of(backend);
    }
  }
}

TEST(RasterScorer, KeptMapsGiveTheSameScoresAsFreshOnes) {
  const mesh::Mesh a = test::bumpy_sphere(3, 1);
  const mesh::Mesh b = test::bumpy_sphere(3, 2);
  const ViewOptions options{.resolution = 48};
  auto poses = test::random_poses(3, 5);
  poses.push_back(poses[0]);
  poses[3].shift_a += 0.05F;  // A moves, B stays
  poses.push_back(poses[1]);
  poses[4].rotation_b = poses[3].rotation_b;
  poses.push_back(poses[0]);  // and back
  const auto kept = make_scorer(Backend::Raster, a, b, options);
  for (const ViewPair& pose : poses) {
    PairScore with;
    PairScore without;
    kept->score({&pose, 1}, {&with, 1});
    make_scorer(Backend::Raster, a, b, options)->score({&pose, 1}, {&without, 1});
    EXPECT_EQ(with.error, without.error);
    EXPECT_EQ(with.overlap, without.overlap);
    EXPECT_EQ(with.covered_a, without.covered_a);
    EXPECT_EQ(with.covered_b, without.covered_b);
  }
}

}  // namespace
}  // namespace rejoin::zbuffer
