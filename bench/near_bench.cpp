/// Google Benchmark of looking for the nearest point, beside nanoflann's k-d tree.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "mesh/detail/kd_tree.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

/// nanoflann's result of a search for the nearest point that starts with a limit.
class NearestWithin {
 public:
  explicit NearestWithin(float squared_radius) : squared_(squared_radius) {}
  bool addPoint(float squared, std::uint32_t /*index*/) {
    squared_ = std::min(squared_, squared);
    return true;
  }
  float worstDist() const { return squared_; }
  bool full() const { return false; }

 private:
  float squared_;
};

/// On a ball of radius 1.
std::vector<glm::vec3> surface(std::size_t count) {
  Random random(1);
  std::vector<glm::vec3> points;
  while (points.size() < count) {
    const glm::dvec3 p(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    if (const double length = glm::length(p); length > 0.05 && length < 0.5) points.emplace_back(p / length);
  }
  return points;
}

/// Between points of surface().
double spacing_of(std::size_t count) {
  return std::sqrt(12.6 / static_cast<double>(count));
}

/// As the samples of a fragment that moves over the other: most a spacing from the surface, some farther off.
std::vector<glm::vec3> asked(std::size_t count) {
  const double spacing = spacing_of(count);
  Random random(2);
  std::vector<glm::vec3> points = surface(4096);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double off = k % 4 == 0 ? 8.0 : 1.0;
    points[k] *= static_cast<float>(1.0 + off * spacing * (random.uniform() - 0.5));
  }
  return points;
}

/// Arguments: points, the radius in spacings.
void by_index(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const auto radius = static_cast<float>(static_cast<double>(state.range(1)) * spacing_of(count));
  const std::vector<glm::vec3> queries = asked(count);
  const PointIndex index(surface(count));
  std::size_t k = 0;
  while (state.KeepRunning())
    benchmark::DoNotOptimize(index.nearest_within(queries[k++ % queries.size()], radius));
}
BENCHMARK(by_index)->ArgsProduct({{1000, 10000, 100000}, {1, 3, 8}});

void by_nanoflann(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const auto radius = static_cast<float>(static_cast<double>(state.range(1)) * spacing_of(count));
  const std::vector<glm::vec3> queries = asked(count);
  const detail::KdPoints points{surface(count)};
  const detail::KdTree tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(detail::kKdLeaf));
  std::size_t k = 0;
  while (state.KeepRunning()) {
    NearestWithin nearest(radius * radius);
    tree.findNeighbors(nearest, &queries[k++ % queries.size()].x, nanoflann::SearchParams());
    benchmark::DoNotOptimize(nearest.worstDist());
  }
}
BENCHMARK(by_nanoflann)->ArgsProduct({{1000, 10000, 100000}, {1, 3, 8}});

/// Argument: points.  Made, and asked once.
void made_by_index(benchmark::State& state) {
  const std::vector<glm::vec3> points = surface(static_cast<std::size_t>(state.range(0)));
  while (state.KeepRunning()) benchmark::DoNotOptimize(PointIndex(points).nearest(points.front()));
}
BENCHMARK(made_by_index)->Arg(1000)->Arg(10000)->Arg(100000);

void made_by_nanoflann(benchmark::State& state) {
  const detail::KdPoints points{surface(static_cast<std::size_t>(state.range(0)))};
  while (state.KeepRunning()) {
    const detail::KdTree tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(detail::kKdLeaf));
    benchmark::DoNotOptimize(&tree);
  }
}
BENCHMARK(made_by_nanoflann)->Arg(1000)->Arg(10000)->Arg(100000);

}  // namespace
}  // namespace rejoin::mesh
