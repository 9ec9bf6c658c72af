/// The compute paths against the fixed pipeline and the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <thread>

#include "core/error.hpp"
#include "shapes.hpp"
#include "zbuffer/gl/gl_backend.hpp"
#include "zbuffer/gl/gl_scorer.hpp"

namespace rejoin::zbuffer::gl {
namespace {

constexpr int kPathResolution = 48;

class GlPaths : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    const BackendInfo info = probe(GetParam());
    ASSERT_TRUE(info.available) << name_of(GetParam()) << ": " << info.why_not << "; run scripts/setup";
  }

  static std::unique_ptr<Scorer> scorer(Path path, const mesh::Mesh& a, const mesh::Mesh& b,
                                        const ViewOptions& options) {
    return make_gl_scorer(shared_engine(GetParam()), GetParam(), a, b, options, path);
  }

  static std::vector<PairScore> score(Scorer& scorer, const std::vector<ViewPair>& poses) {
    std::vector<PairScore> scores(poses.size());
    scorer.score(poses, scores);
    return scores;
  }
};

void expect_equal_bytes(const std::vector<PairScore>& a, const std::vector<PairScore>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(PairScore)), 0);
}

/// The same pixels in every map, so the same counts; sums differ by rounding alone.
void expect_same_pixels(const std::vector<PairScore>& a, const std::vector<PairScore>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].overlap, b[k].overlap);
    EXPECT_EQ(a[k].covered_a, b[k].covered_a);
    EXPECT_EQ(a[k].covered_b, b[k].covered_b);
    if (b[k].overlap > 0) {
      EXPECT_NEAR(a[k].error, b[k].error, 1e-5 * b[k].error + 1e-8);
    }
  }
}

TEST_P(GlPaths, ComputeDrawsThePixelsOfTheReference) {
  const mesh::Mesh a = test::bumpy_sphere(3, 1);
  const mesh::Mesh b = test::bumpy_sphere(2, 2);
  const ViewOptions options{.resolution = kPathResolution, .view_side = 2.9, .centre_a = {0.1F, 0, -0.2F}};
  const auto poses = test::random_poses(8, 31);
  const auto truth = score(*make_scorer(Backend::Reference, a, b, options), poses);
  expect_same_pixels(score(*scorer(Path::Compute, a, b, options), poses), truth);
}

TEST_P(GlPaths, ComputeDepthsAreThoseOfTheReference) {
  const mesh::Mesh a = test::bumpy_sphere(3, 3);
  const mesh::Mesh b = test::height_field(0.9F, 1, [](float x, float y) { return 0.3F * x - 0.1F * y; });
  const ViewOptions options{.resolution = 100, .view_side = 2.9};
  const auto tested = scorer(Path::Compute, a, b, options);
  const auto reference = make_scorer(Backend::Reference, a, b, options);
  for (const ViewPair& pose : test::random_poses(4, 32)) {
    const auto seen = tested->depth_maps(pose);
    const auto truth = reference->depth_maps(pose);
    for (const auto& [x, y] :
         {std::pair{&seen.first, &truth.first}, std::pair{&seen.second, &truth.second}}) {
      for (std::size_t k = 0; k < x->depth.size(); ++k) {
        ASSERT_EQ(std::isnan(x->depth[k]), std::isnan(y->depth[k])) << k;
        // Weights and depths are floats: a few roundings of the depth, which is at most the view's side.
        if (std::isnan(y->depth[k])) continue;
        ASSERT_NEAR(x->depth[k], y->depth[k], 1e-6 * options.view_side) << k;
      }
    }
  }
}

TEST_P(GlPaths, PipelineAgreesToItsSubPixelGrid) {
  const mesh::Mesh a = test::bumpy_sphere(4, 1);
  const mesh::Mesh b = test::bumpy_sphere(4, 2);
  const ViewOptions options{.resolution = 128, .view_side = 2.9};
  const auto poses = test::random_poses(10, 33);
  const auto compute = score(*scorer(Path::Compute, a, b, options), poses);
  const auto pipeline = score(*scorer(Path::Pipeline, a, b, options), poses);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    // GL moves corners to 1/256 pixel or finer: a pixel's edge at silhouettes, steep depths a little.
    EXPECT_NEAR(pipeline[k].error, compute[k].error, 0.01 * compute[k].error);
    EXPECT_NEAR(pipeline[k].overlap, compute[k].overlap, 0.002 * compute[k].overlap);
    EXPECT_NEAR(pipeline[k].covered_a, compute[k].covered_a, 0.002 * compute[k].covered_a);
    EXPECT_NEAR(pipeline[k].covered_b, compute[k].covered_b, 0.002 * compute[k].covered_b);
  }
}

/// What may and what may not be left out where it looks away, in one mesh.
TEST_P(GlPaths, OpenClosedAndInsideOutPartsAreDrawnAsInTheReference) {
  const mesh::Mesh patch = test::height_field(0.5F, 12, [](float x, float y) { return 0.2F * x * y; });
  const mesh::Mesh ball = test::bumpy_sphere(2, 4);
  const mesh::Mesh a = test::together(test::together(test::moved(patch, {0, 0.3F, 1.1F}), ball),
                                      test::inside_out(test::moved(ball, {0.9F, 0, 0})));
  const mesh::Mesh b = test::bumpy_sphere(2, 5);
  const ViewOptions options{.resolution = kPathResolution, .view_side = 4.0};
  const auto poses = test::random_poses(12, 35);
  const auto truth = score(*make_scorer(Backend::Reference, a, b, options), poses);
  expect_same_pixels(score(*scorer(Path::Compute, a, b, options), poses), truth);
  const auto pipeline = score(*scorer(Path::Pipeline, a, b, options), poses);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    // As above, but each map has a tenth of the pixels, so silhouettes weigh three times as much.
    EXPECT_NEAR(pipeline[k].error, truth[k].error, 0.03 * truth[k].error);
    EXPECT_NEAR(pipeline[k].covered_a, truth[k].covered_a, 0.006 * truth[k].covered_a);
  }
}

TEST_P(GlPaths, FewHugeTrianglesAndManySmallOnesScoreAsOnTheCpu) {
  const mesh::Mesh huge = test::height_field(40.0F, 1, [](float x, float y) { return 0.1F * x + 0.05F * y; });
  const mesh::Mesh fine = test::bumpy_sphere(5, 7);  // 20,480 faces, most without a pixel
  for (const int resolution : {16, 40, 200}) {
    const ViewOptions options{.resolution = resolution, .view_side = 2.9};
    const auto poses = test::random_poses(5, 34);
    expect_same_pixels(score(*scorer(Path::Auto, huge, fine, options), poses),
                       score(*make_scorer(Backend::Raster, huge, fine, options), poses));
  }
}

TEST_P(GlPaths, WorkThatTheDriverCutsShortIsStillScored) {
  // Software drivers give up on so many pixels in one work group; hardware does not.
  const mesh::Mesh a = test::bumpy_sphere(2, 8);
  const ViewOptions options{.resolution = 2048, .view_side = 2.9};
  const auto poses = test::random_poses(1, 35);
  const auto truth = score(*make_scorer(Backend::Raster, a, a, options), poses);
  for (const Path path : {Path::Auto, Path::ComputeAnyway, Path::Pipeline}) {
    const auto tested = score(*scorer(path, a, a, options), poses);
    EXPECT_NEAR(tested[0].error, truth[0].error, 0.01 * truth[0].error);
    EXPECT_NEAR(tested[0].overlap, truth[0].overlap, 1e-4 * truth[0].overlap);
  }
  // What was left undone must not show in the maps of those who draw next, as many as reach the end of the large ones.
  const ViewOptions next{.resolution = 512, .view_side = 2.9};
  const auto others = test::random_poses(16, 41);
  expect_same_pixels(score(*scorer(Path::Compute, a, a, next), others),
                     score(*make_scorer(Backend::Raster, a, a, next), others));
}

TEST_P(GlPaths, EveryBatchSizeGivesTheSameBytes) {
  const mesh::Mesh a = test::bumpy_sphere(2, 4);
  const mesh::Mesh b = test::bumpy_sphere(2, 5);
  const auto poses = test::random_poses(300, 36);
  for (const Path path : {Path::Compute, Path::Pipeline}) {
    const auto s = scorer(path, a, b, {.resolution = kPathResolution});
    const auto whole = score(*s, poses);
    expect_equal_bytes(score(*s, poses), whole);
    for (const std::size_t batch : {1U, 7U}) {
      std::vector<PairScore> split(whole.size());
      for (std::size_t k = 0; k < poses.size(); k += batch) {
        const std::size_t count = std::min(batch, poses.size() - k);
        s->score(std::span(poses).subspan(k, count), std::span(split).subspan(k, count));
      }
      expect_equal_bytes(split, whole);
    }
    expect_equal_bytes(score(*scorer(path, a, b, {.resolution = kPathResolution}), poses), whole);
  }
}

TEST_P(GlPaths, FacesWithCornersThatAreNotFiniteAreNotDrawn) {
  const mesh::Mesh whole = test::bumpy_sphere(2, 6);
  mesh::Mesh broken = whole;
  broken.vertices.push_back({NAN, 0, 0});
  broken.vertices.push_back({0, INFINITY, 0});
  const auto last = static_cast<std::uint32_t>(broken.vertices.size() - 1);
  broken.faces.push_back({0, 1, last});
  broken.faces.push_back({last - 1, 1, 2});
  const auto poses = test::random_poses(3, 37);
  const ViewOptions options{.resolution = kPathResolution, .view_side = 2.9};
  for (const Path path : {Path::Compute, Path::Pipeline}) {
    expect_equal_bytes(score(*scorer(path, broken, broken, options), poses),
                       score(*scorer(path, whole, whole, options), poses));
  }
}

TEST_P(GlPaths, NothingDependsOnTheUnitOfLength) {
  const mesh::Mesh a = test::bumpy_sphere(3, 9);
  const auto poses = test::random_poses(3, 38);
  const auto truth = score(*scorer(Path::Auto, a, a, {.resolution = 64, .view_side = 2.5}), poses);
  for (const float unit : {0x1p-20F, 0x1p20F}) {  // powers of two: no rounding at all
    mesh::Mesh scaled = a;
    for (glm::vec3& v : scaled.vertices) v *= unit;
    auto moved = poses;
    for (ViewPair& pose : moved) pose.shift_a *= unit;
    const auto scores =
        score(*scorer(Path::Auto, scaled, scaled, {.resolution = 64, .view_side = 2.5 * unit}), moved);
    expect_equal_bytes(scores, truth);
  }
}

TEST_P(GlPaths, NoPathMisusesOpenGl) {
  // A debug context makes the scorer throw at whatever the driver objects to.
  const auto engine = std::make_shared<Engine>(make_context(GetParam(), {.soname = {}, .debug = true}));
  const mesh::Mesh a = test::bumpy_sphere(2, 11);
  const auto poses = test::random_poses(20, 40);
  for (const Path path : {Path::Compute, Path::Pipeline}) {
    const auto s = make_gl_scorer(engine, GetParam(), a, a, {.resolution = kPathResolution}, path);
    EXPECT_NO_THROW(score(*s, poses));
    EXPECT_NO_THROW(s->depth_maps(poses[0]));
    EXPECT_NO_THROW(score(*s, {}));
  }
}

TEST_P(GlPaths, ScorersInTwoThreadsTakeTurns) {
  const mesh::Mesh a = test::bumpy_sphere(2, 10);
  const auto poses = test::random_poses(40, 39);
  const auto truth = score(*scorer(Path::Auto, a, a, {.resolution = kPathResolution}), poses);
  std::vector<std::vector<PairScore>> found(2);
  std::vector<std::thread> threads;
  threads.reserve(found.size());
  for (std::vector<PairScore>& scores : found) {
    threads.emplace_back([&] {
      const auto mine = scorer(Path::Auto, a, a, {.resolution = kPathResolution});
      for (int k = 0; k < 3; ++k) scores = score(*mine, poses);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& scores : found) expect_equal_bytes(scores, truth);
}

INSTANTIATE_TEST_SUITE_P(Backends, GlPaths, testing::Values(Backend::Gpu, Backend::OsMesa),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace rejoin::zbuffer::gl
