/// Google Benchmark of the sweep's correlation: all shifts of one slope map over another at once by FFT, and one after the other.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "match/correlate.hpp"

namespace rejoin::match {
namespace {

/// A break as large as its map allows, in the shape of an ellipse, with slopes of waves of all lengths down to a few pixels.
ReliefMap relief(int width, int height, std::uint64_t seed) {
  Random random(seed);
  ReliefMap map;
  map.width = width;
  map.height = height;
  map.pitch = 1.0;
  struct Wave {
    double u, v, phase;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 12; ++k)
    waves.push_back({2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, 6.28 * random.uniform()});
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const double x = (2.0 * i + 1.0) / width - 1.0;
      const double y = (2.0 * j + 1.0) / height - 1.0;
      const bool covered = x * x + y * y < 1.0;
      glm::dvec2 slope(0.0);
      for (const Wave& w : waves) slope += 0.2 * std::cos(w.u * i + w.v * j + w.phase) * glm::dvec2(w.u, w.v);
      map.height_map.push_back(0.0F);
      map.mask.push_back(covered ? 1.0F : 0.0F);
      map.slope_u.push_back(covered ? static_cast<float>(slope.x) : 0.0F);
      map.slope_v.push_back(covered ? static_cast<float>(slope.y) : 0.0F);
    }
  }
  count_pixels(map);
  return map;
}

/// Arguments: pixels across and up of both maps.
void all_shifts_by_fft(benchmark::State& state) {
  const auto width = static_cast<int>(state.range(0));
  const auto height = static_cast<int>(state.range(1));
  Correlator correlator(relief(width, height, 1), {});
  const ReliefMap other = relief(width, height, 2);
  long shifts = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(correlator.peaks(other));
    shifts += correlator.shifts();
  }
  state.SetItemsProcessed(shifts);
}

/// The same shifts, each by direct summation (agreement_at()).
void all_shifts_directly(benchmark::State& state) {
  const auto width = static_cast<int>(state.range(0));
  const auto height = static_cast<int>(state.range(1));
  const ReliefMap fixed = relief(width, height, 1);
  const ReliefMap other = relief(width, height, 2);
  long shifts = 0;
  for (auto _ : state) {
    for (int v = 1 - height; v < height; ++v) {
      for (int u = 1 - width; u < width; ++u, ++shifts)
        benchmark::DoNotOptimize(agreement_at(fixed, other, u, v, {}));
    }
  }
  state.SetItemsProcessed(shifts);
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({40, 7})->Args({20, 20})->Args({40, 40})->Args({80, 80})->Unit(benchmark::kMicrosecond);
}

BENCHMARK(all_shifts_by_fft)->Apply(sizes);
BENCHMARK(all_shifts_directly)->Apply(sizes);

}  // namespace
}  // namespace rejoin::match
