#include "outline/detail/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/cyclic.hpp"

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

/// A stretch on a diagonal, with its gain sum(xi^2 - mismatch).
struct Stretch {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::int32_t length = 0;
  double gain = 0.0;
};

/// Looks for the stretches of greatest gain on one diagonal.
class DiagonalScan {
 public:
  DiagonalScan(const ScaleParameters& parameters, std::int32_t least, std::vector<Stretch>& found)
      : xi2_(parameters.xi * parameters.xi),
        least_gain_(xi2_ * parameters.n_min),
        least_(least),
        found_(found) {}

  /// \param a, b  the sequences without wrap; A's run from its beginning, B's from first_j on
  void run(const Sequence& a, const Sequence& b, std::int32_t count, std::int32_t first_j,
           std::int32_t last_start) {
    const float* values_b = b.values.data() + first_j;
    const float* relief_b = b.relief.data() + first_j;
    const auto xi2 = static_cast<float>(xi2_);
    const auto drop = static_cast<float>(kDrop * xi2_);
    float gain = 0.0F;
    float best = 0.0F;
    std::int32_t begin = 0;
    std::int32_t end = 0;
    for (std::int32_t t = 0; t < count; ++t) {
      const auto k = static_cast<std::size_t>(t);
      const float d = a.values[k] - values_b[k];
      gain += xi2 * a.relief[k] * relief_b[k] - d * d;
      if (gain > best) {
        best = gain;
        end = t + 1;
      } else if (gain <= 0.0F || gain < best - drop) {
        add(begin, end, best, first_j);
        if (t >= last_start) return;
        gain = best = 0.0F;
        begin = end = t + 1;
      }
    }
    add(begin, end, best, first_j);
  }

 private:
  static constexpr double kDrop =
      6.0;  ///< a stretch ends where it has lost as much as this many perfect samples give

  void add(std::int32_t begin, std::int32_t end, float gain, std::int32_t first_j) {
    if (end - begin < least_ || gain <= least_gain_) return;
    found_.push_back({begin, first_j + begin, end - begin, gain});
  }

  double xi2_;
  double least_gain_;
  std::int32_t least_;
  std::vector<Stretch>& found_;
};

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

/// The sequence gone round until it has `length` samples or more.
Sequence unrolled(const Sequence& sequence, std::size_t length) {
  Sequence result;
  while (result.values.size() < length) {
    result.values.insert(result.values.end(), sequence.values.begin(), sequence.values.end());
    result.relief.insert(result.relief.end(), sequence.relief.begin(), sequence.relief.end());
  }
  return result;
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
  const auto size_b = static_cast<std::int32_t>(sequences.b->values.size());
  // A stretch may run over A's end once, and over B's end as often as A's length asks.
  const std::int32_t count = size_a + std::min(size_a, size_b);
  const auto length = static_cast<std::size_t>(count);
  const Sequence a = unrolled(*sequences.a, length);
  const Sequence b = unrolled(*sequences.b, length + sequences.b->values.size());
  std::vector<Stretch> found;
  DiagonalScan scan(parameters, least, found);
  for (std::int32_t j = 0; j < size_b; ++j) scan.run(a, b, count, j, size_a);
  for (Stretch& s : found) s.length = std::min({s.length, size_a, size_b});
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
