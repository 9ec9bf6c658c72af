#include "zbuffer/benchmark.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string_view>
#include <utility>

#include "core/error.hpp"

namespace rejoin::zbuffer {
namespace {

TEST(BumpySphere, IsClosedAndSeenFromOutside) {
  const mesh::Mesh sphere = bumpy_sphere(1000, 3);
  EXPECT_NEAR(static_cast<double>(sphere.faces.size()), 1000.0, 120.0);  // 12 k^2 nearest to it: 972
  std::map<std::pair<unsigned, unsigned>, int> edges;
  double volume = 0;
  for (const glm::uvec3& f : sphere.faces) {
    for (int k = 0; k < 3; ++k) ++edges[{f[k], f[(k + 1) % 3]}];
    const glm::dvec3 a(sphere.vertices[f.x]);
    volume +=
        glm::dot(a, glm::cross(glm::dvec3(sphere.vertices[f.y]), glm::dvec3(sphere.vertices[f.z]))) / 6.0;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
  EXPECT_NEAR(volume, 4.19, 0.6);  // a ball of radius 1 with bumps
}

TEST(Benchmark, HasARowForEachBackendResolutionAndNumberOfThreads) {
  const BenchmarkOptions options{.faces = {300},
                                 .resolutions = {16, 32},
                                 .threads = {2, 1, 1},
                                 .backends = {Backend::Raster, Backend::RayCast},
                                 .seconds_per_row = 0.001};
  const auto rows = benchmark(options, Context());
  ASSERT_EQ(rows.size(), 8U);
  for (const BenchmarkRow& row : rows) {
    EXPECT_EQ(row.faces, 300U);  // 12 * 5^2
    EXPECT_GT(row.evaluations_per_second, 0.0);
    EXPECT_FALSE(row.renderer.empty());
  }
  EXPECT_EQ(rows[0].threads, 1);
  EXPECT_EQ(rows[1].threads, 2);
  EXPECT_EQ(rows[2].resolution, 32);
}

TEST(Benchmark, MeasuresBothWaysOfOpenGlAtEveryBatch) {
  for (const BackendInfo& info : list_backends()) {
    if (info.backend != Backend::Gpu && info.backend != Backend::OsMesa) continue;
    const BenchmarkOptions options{.faces = {300, 12},
                                   .resolutions = {16},
                                   .batches = {1, 3},
                                   .backends = {info.backend},
                                   .seconds_per_row = 0.001};
    const auto rows = benchmark(options, Context());
    ASSERT_EQ(rows.size(), info.available ? 8U : 0U) << name_of(info.backend);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_EQ(rows[k].faces, k < 4 ? 300U : 12U);
      EXPECT_EQ(rows[k].way, k % 4 < 2 ? "compute" : "pipeline");
      EXPECT_EQ(rows[k].batch, k % 2 == 0 ? 1U : 3U);
      EXPECT_GT(rows[k].evaluations_per_second, 0.0);
    }
  }
}

TEST(Benchmark, RatiosAreTakenWithinOneResolutionAndNumberOfFaces) {
  const auto row = [](Backend backend, const char* way, int resolution, int threads, double rate) {
    BenchmarkRow made;
    made.backend = backend;
    made.way = way;
    made.resolution = resolution;
    made.threads = threads;
    made.evaluations_per_second = rate;
    return made;
  };
  const auto ratios =
      ratios_of({row(Backend::Raster, "", 64, 1, 100), row(Backend::Raster, "", 64, 4, 380),
                 row(Backend::Raster, "", 128, 1, 50), row(Backend::RayCast, "", 64, 1, 10),
                 row(Backend::RayCast, "", 128, 1, 4), row(Backend::RayCast, "", 64, 4, 40),
                 row(Backend::OsMesa, "pipeline", 64, 4, 2), row(Backend::OsMesa, "compute", 128, 4, 2)});
  ASSERT_EQ(ratios.size(), 4U);
  EXPECT_EQ(ratios[0].of, "raster, 1 thread");
  EXPECT_EQ(ratios[0].to, "raycast, 1 thread");
  EXPECT_EQ(ratios[0].ratio, 10.0);
  EXPECT_EQ(ratios[1].resolution, 128);
  EXPECT_EQ(ratios[1].ratio, 12.5);
  EXPECT_EQ(ratios[2].of, "raster, 4 threads");
  EXPECT_EQ(ratios[2].ratio, 3.8);
  EXPECT_EQ(ratios[3].to, "osmesa pipeline");
  EXPECT_EQ(ratios[3].ratio, 190.0);
}

TEST(Benchmark, EndsWhenCancelled) {
  Context context;
  context.cancel();
  EXPECT_TRUE(benchmark({.faces = {12}, .backends = {Backend::Raster}}, context).empty());
}

TEST(Benchmark, HasNoRowOfWhatWasInterrupted) {
  Context* own = nullptr;
  const Context::Progress cancel_at_the_second = [&](std::string_view /*stage*/, double fraction) {
    if (fraction > 0.0) own->cancel();
  };
  Context context(cancel_at_the_second);
  own = &context;
  const BenchmarkOptions options{.faces = {12},
                                 .resolutions = {16, 32, 64},
                                 .threads = {1},
                                 .backends = {Backend::Raster},
                                 .seconds_per_row = 0.001};
  EXPECT_EQ(benchmark(options, context).size(), 1U);
}

TEST(Benchmark, MeshWithoutFacesThrows) {
  const mesh::Mesh empty;
  EXPECT_THROW(benchmark({.a = &empty, .backends = {Backend::Raster}}, Context()), InputError);
}

}  // namespace
}  // namespace rejoin::zbuffer
