/// How many poses a second each backend scores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/context.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::zbuffer {

struct BenchmarkOptions {
  const mesh::Mesh* a = nullptr;  ///< not owned; null: a generated bumpy sphere of about `faces` faces
  const mesh::Mesh* b = nullptr;  ///< likewise
  std::vector<std::size_t> faces{10000};       ///< of generated spheres, at least 12
  std::vector<int> resolutions{64, 128, 256};  ///< pixels
  std::vector<int> threads{};                  ///< empty: 1 and all cores
  std::vector<std::size_t> batches{};          ///< poses a call; empty: as many as take a while
  std::vector<Backend> backends{};             ///< empty: every available one but the reference
  double seconds_per_row = 0.5;                ///< measured time of a row, after a few poses to warm up
  std::uint64_t seed = 1;                      ///< of the orientations, uniform over all rotations
};

/// One measurement.  An evaluation = both depth maps of a new pose, their slope difference and overlap.
struct BenchmarkRow {
  Backend backend = Backend::Auto;
  std::string way;  ///< of GL: "compute" or "pipeline"; empty for the others
  std::string renderer;
  int resolution = 0;
  std::size_t faces = 0;  ///< mean of the two fragments
  int threads = 0;
  std::size_t batch = 0;  ///< poses a call; 0: as many as take a while
  double evaluations_per_second = 0;
  double evaluations_per_cpu_second = 0;  ///< of all threads of the process: says more on a busy machine
};

/// Two rates of one run, at one resolution and number of faces.
struct BenchmarkRatio {
  std::string of;  ///< "raster, 1 thread"
  std::string to;
  int resolution = 0;
  std::size_t faces = 0;
  double ratio = 0;
};

/// A closed sphere with bumps of several sizes, radius about 1, 12 k^2 faces with the k that comes nearest to
/// `faces`.
mesh::Mesh bumpy_sphere(std::size_t faces, std::uint64_t seed);

/// Poses with both fragments turned at random, evenly over all rotations.
std::vector<ViewPair> random_poses(std::size_t count, std::uint64_t seed);

/// One row for each backend, number of faces, resolution, number of threads and batch.  GL backends do not use
/// our threads, but draw in two ways: a row for each.  A backend that fails gets no row.  Ends early, with the
/// rows measured so far, when the context is cancelled.
/// \throws InputError  as make_scorer
std::vector<BenchmarkRow> benchmark(const BenchmarkOptions& options, const Context& context);

/// What the rows say about the backends: the rasteriser against Embree, one thread each; on all threads against
/// one and against each way of GL.  Of rows without a fixed batch; what was not measured has no ratio.
std::vector<BenchmarkRatio> ratios_of(const std::vector<BenchmarkRow>& rows);

}  // namespace rejoin::zbuffer
