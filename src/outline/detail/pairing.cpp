#include "outline/detail/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/cyclic.hpp"
#include "outline/detail/diagonals.hpp"

namespace rejoin::outline::detail {
namespace {

/// Candidates this near to each other across the diagonal are the same, samples.
constexpr int kSameDiagonal = 2;

/// Squared difference of two samples, and the share of xi^2 that is allowed there.
struct Cell {
  double mismatch = 0.0;
  double relief = 0.0;
};

Cell cell(const Sequences& s, const PairedSamples& at) {
  const std::size_t i = wrapped(at.i, s.a->values.size());
  const std::size_t j = wrapped(at.j, s.b->values.size());
  const double d = static_cast<double>(s.a->values[i]) - static_cast<double>(s.b->values[j]);
  return {d * d, static_cast<double>(s.a->relief[i]) * static_cast<double>(s.b->relief[j])};
}

/// Difference of two diagonals on the closed sequences.
std::int32_t diagonal_distance(std::int32_t a, std::int32_t b, std::size_t size) {
  const std::int32_t apart = std::abs(a - b) % static_cast<std::int32_t>(size);
  return std::min(apart, static_cast<std::int32_t>(size) - apart);
}

bool same_stretch(const Stretch& a, const Stretch& b, std::size_t size_b) {
  if (diagonal_distance(a.j - a.i, b.j - b.i, size_b) > kSameDiagonal) return false;
  const std::int32_t common = std::min(a.i + a.length, b.i + b.length) - std::max(a.i, b.i);
  return 2 * common > std::min(a.length, b.length);
}

Candidate straight(const Stretch& stretch, const ScaleParameters& parameters) {
  Candidate candidate;
  candidate.path.reserve(static_cast<std::size_t>(stretch.length));
  for (std::int32_t t = 0; t < stretch.length; ++t) candidate.path.push_back({stretch.i + t, stretch.j + t});
  candidate.discriminant = parameters.xi * parameters.xi * parameters.n_min - stretch.gain;
  return candidate;
}

}  // namespace

double discriminant(const Sequences& sequences, const std::vector<PairedSamples>& path,
                    const ScaleParameters& parameters) {
  const double xi2 = parameters.xi * parameters.xi;
  const double zeta2 = parameters.zeta * parameters.zeta;
  double sum = xi2 * parameters.n_min;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const int tau = path[k + 1].i - path[k].i + path[k + 1].j - path[k].j;
    const Cell from = cell(sequences, path[k]);
    const Cell to = cell(sequences, path[k + 1]);
    sum += 0.25 * (from.mismatch + to.mismatch - xi2 * (from.relief + to.relief)) * tau;
    if (tau == 1) sum += 0.5 * zeta2;
  }
  return sum;
}

std::vector<Candidate> initial_candidates(const Sequences& sequences, const ScaleParameters& parameters,
                                          int least, std::size_t most) {
  const auto size_a = static_cast<std::int32_t>(sequences.a->values.size());
  const double xi2 = parameters.xi * parameters.xi;
  std::vector<Stretch> found = find_stretches(sequences, {xi2, xi2 * parameters.n_min, least});
  std::sort(found.begin(), found.end(), [](const Stretch& x, const Stretch& y) {
    return x.gain != y.gain ? x.gain > y.gain : (x.i != y.i ? x.i < y.i : x.j < y.j);
  });
  std::vector<Stretch> kept;
  for (const Stretch& s : found) {
    if (kept.size() == most) break;
    const auto same = [&](const Stretch& other) {
      Stretch later = s;
      later.i += size_a;
      later.j += size_a;
      return same_stretch(s, other, sequences.b->values.size()) ||
             same_stretch(later, other, sequences.b->values.size());
    };
    if (std::none_of(kept.begin(), kept.end(), same)) kept.push_back(s);
  }
  std::vector<Candidate> candidates;
  candidates.reserve(kept.size());
  for (const Stretch& s : kept) candidates.push_back(straight(s, parameters));
  return candidates;
}

}  // namespace rejoin::outline::detail
