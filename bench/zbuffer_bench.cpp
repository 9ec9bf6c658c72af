/// Google Benchmarks of the parts of a pose evaluation.
#include <benchmark/benchmark.h>

#include <array>

#include "core/parallel.hpp"
#include "core/rigid.hpp"
#include "zbuffer/benchmark.hpp"
#include "zbuffer/error.hpp"

namespace rejoin::zbuffer {
namespace {

/// Poses that repeat nothing: A turns by the golden angle about a tilted axis, B about another.
ViewPair pose_number(int k) {
  const double angle = 2.399963 * k;
  return {.rotation_a = glm::mat3(axis_rotation(glm::normalize(glm::dvec3(1, 2, 3)), angle)),
          .rotation_b = glm::mat3(axis_rotation(glm::normalize(glm::dvec3(-3, 1, 2)), angle))};
}

/// Arguments: pixels, faces.  One thread, both maps and the error.
template <Backend backend>
void score_one_pose(benchmark::State& state) {
  const ThreadLimit limit(1);
  const auto faces = static_cast<std::size_t>(state.range(1));
  const auto scorer = make_scorer(backend, bumpy_sphere(faces, 1), bumpy_sphere(faces, 2),
                                  {.resolution = static_cast<int>(state.range(0))});
  int k = 0;
  while (state.KeepRunning()) {
    const ViewPair pose = pose_number(k++);
    PairScore score;
    scorer->score({&pose, 1}, {&score, 1});
    benchmark::DoNotOptimize(score);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(score_one_pose<Backend::Raster>)->ArgsProduct({{64, 128, 256}, {1000, 10000, 100000}});
BENCHMARK(score_one_pose<Backend::RayCast>)->ArgsProduct({{64, 128, 256}, {1000, 10000, 100000}});

/// Argument: pixels.  The error alone.
void error_of_two_maps(benchmark::State& state) {
  const auto pixels = static_cast<int>(state.range(0));
  const auto scorer =
      make_scorer(Backend::Raster, bumpy_sphere(10000, 1), bumpy_sphere(10000, 2), {.resolution = pixels});
  const auto [a, b] = scorer->depth_maps(pose_number(1));
  while (state.KeepRunning()) benchmark::DoNotOptimize(slope_difference(a, b, 1.0));
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(state.iterations() * 2 * pixels * pixels * static_cast<int>(sizeof(float)));
}
BENCHMARK(error_of_two_maps)->Arg(64)->Arg(128)->Arg(256);

}  // namespace
}  // namespace rejoin::zbuffer
