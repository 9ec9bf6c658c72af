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
  std::size_t faces = 10000;      ///< of a generated sphere, at least 12
  std::vector<int> resolutions{64, 128, 256};  ///< pixels
  std::vector<int> threads{};                  ///< empty: 1 and all cores
  std::vector<Backend> backends{};             ///< empty: every available one but the reference
  double seconds_per_row = 0.5;                ///< measured time of a row, after one batch to warm up
  std::uint64_t seed = 1;                      ///< of the orientations, uniform over all rotations
};

/// One measurement.  An evaluation = both depth maps of a new pose, their slope difference and overlap.
struct BenchmarkRow {
  Backend backend = Backend::Auto;
  std::string renderer;
  int resolution = 0;
  std::size_t faces = 0;  ///< mean of the two fragments
  int threads = 0;
  double evaluations_per_second = 0;
};

/// A closed sphere with bumps of several sizes, radius about 1, 12 k^2 faces with the k that comes nearest to
/// `faces`.
mesh::Mesh bumpy_sphere(std::size_t faces, std::uint64_t seed);

/// One row for each backend, resolution and number of threads.  GL backends do not use our threads: one row
/// each. A backend that fails gets no row.  Ends early, with the rows so far, when the context is cancelled.
/// \throws InputError  as make_scorer
std::vector<BenchmarkRow> benchmark(const BenchmarkOptions& options, const Context& context);

}  // namespace rejoin::zbuffer
