#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/cyclic.hpp"
#include "outline/detail/pairing.hpp"

namespace rejoin::outline::detail {
namespace {

enum Step : std::uint8_t { kStart, kBoth, kOnlyA, kOnlyB };

/// Dynamic programming over rows i = first .. first + rows - 1, in each over columns centre(i) - band .. centre(i) + band.
/// Maximises the gain xi^2 n_min - Delta of a path with free ends.
class Band {
 public:
  Band(const Sequences& sequences, const ScaleParameters& parameters, std::int32_t first,
       std::vector<std::int32_t> centres, int band)
      : s_(sequences),
        xi2_(parameters.xi * parameters.xi),
        zeta2_(parameters.zeta * parameters.zeta),
        first_(first),
        centres_(std::move(centres)),
        band_(band),
        width_(static_cast<std::size_t>(2 * band + 1)),
        gains_(centres_.size() * width_, 0.0F),
        balances_(gains_.size()),
        steps_(gains_.size(), kStart) {}

  Candidate run(double n_min) {
    std::size_t best = 0;
    for (std::size_t row = 0; row < centres_.size(); ++row) {
      fill_balances(row);
      for (std::size_t column = 0; column < width_; ++column) {
        update(row, column);
        if (gains_[row * width_ + column] > gains_[best]) best = row * width_ + column;
      }
    }
    Candidate candidate;
    candidate.discriminant = xi2_ * n_min - gains_[best];
    trace(best, candidate.path);
    return candidate;
  }

 private:
  std::int32_t j_of(std::size_t row, std::size_t column) const {
    return centres_[row] - band_ + static_cast<std::int32_t>(column);
  }

  void fill_balances(std::size_t row) {
    const std::size_t i = wrapped(first_ + static_cast<std::int32_t>(row), s_.a->values.size());
    const float value = s_.a->values[i];
    const float allowed = static_cast<float>(xi2_) * s_.a->relief[i];
    std::size_t j = wrapped(j_of(row, 0), s_.b->values.size());
    for (std::size_t column = 0; column < width_; ++column) {
      const float d = value - s_.b->values[j];
      balances_[row * width_ + column] = allowed * s_.b->relief[j] - d * d;
      if (++j == s_.b->values.size()) j = 0;
    }
  }

  /// Where column j lies in a row; width_ if outside.
  std::size_t column_in(std::size_t row, std::int32_t j) const {
    const std::int32_t column = j - centres_[row] + band_;
    return column < 0 || column >= static_cast<std::int32_t>(width_) ? width_
                                                                     : static_cast<std::size_t>(column);
  }

  void offer(std::size_t from, std::size_t to, Step step) {
    const float span = step == kBoth ? 1.0F : 0.5F;
    const float penalty = step == kBoth ? 0.0F : 0.5F * static_cast<float>(zeta2_);
    const float gain = gains_[from] + 0.5F * span * (balances_[from] + balances_[to]) - penalty;
    if (gain <= gains_[to]) return;
    gains_[to] = gain;
    steps_[to] = step;
  }

  void update(std::size_t row, std::size_t column) {
    const std::size_t here = row * width_ + column;
    if (row > 0) {
      const std::int32_t j = j_of(row, column);
      const std::size_t diagonal = column_in(row - 1, j - 1);
      const std::size_t above = column_in(row - 1, j);
      if (diagonal < width_) offer((row - 1) * width_ + diagonal, here, kBoth);
      if (above < width_) offer((row - 1) * width_ + above, here, kOnlyA);
    }
    if (column > 0) offer(here - 1, here, kOnlyB);
  }

  void trace(std::size_t cell, std::vector<PairedSamples>& path) const {
    while (true) {
      const std::size_t row = cell / width_;
      const std::size_t column = cell % width_;
      const std::int32_t j = j_of(row, column);
      path.push_back({first_ + static_cast<std::int32_t>(row), j});
      const Step step = static_cast<Step>(steps_[cell]);
      if (step == kStart) break;
      if (step == kBoth) cell = (row - 1) * width_ + column_in(row - 1, j - 1);
      if (step == kOnlyA) cell = (row - 1) * width_ + column_in(row - 1, j);
      if (step == kOnlyB) cell -= 1;
    }
    std::reverse(path.begin(), path.end());
  }

  const Sequences& s_;
  double xi2_;
  double zeta2_;
  std::int32_t first_;
  std::vector<std::int32_t> centres_;
  std::int32_t band_;
  std::size_t width_;
  std::vector<float> gains_;
  std::vector<float> balances_;  ///< what a sample pair gains: xi^2 with its relief, less the mismatch
  std::vector<std::uint8_t> steps_;
};

/// j of a pairing at row i, straight between its samples.
std::vector<std::int32_t> centres_of(const std::vector<PairedSamples>& path, std::size_t most_rows) {
  const auto rows = std::min(static_cast<std::size_t>(path.back().i - path.front().i) + 1, most_rows);
  std::vector<std::int32_t> centres;
  centres.reserve(rows);
  std::size_t k = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::int32_t i = path.front().i + static_cast<std::int32_t>(row);
    while (k + 2 < path.size() && path[k + 1].i <= i) ++k;
    const PairedSamples& a = path[k];
    const PairedSamples& b = path[std::min(k + 1, path.size() - 1)];
    const double share = b.i > a.i ? static_cast<double>(i - a.i) / (b.i - a.i) : 0.0;
    centres.push_back(static_cast<std::int32_t>(std::lround(a.j + share * (b.j - a.j))));
  }
  return centres;
}

/// Covered by both on nearly the same diagonal, rows; `shift` moves the second by whole turns.
struct Overlap {
  std::int32_t rows = 0;
  PairedSamples shift;
};

constexpr std::int32_t kSameTrack = 3;

/// j of a path at row i; the path's rows never skip.
std::int32_t j_at(const std::vector<PairedSamples>& path, std::int32_t i) {
  const auto at = std::lower_bound(path.begin(), path.end(), i,
                                   [](const PairedSamples& p, std::int32_t row) { return p.i < row; });
  return at == path.end() ? path.back().j : at->j;
}

Overlap overlap(const Candidate& a, const Candidate& b, std::size_t size_a, std::size_t size_b) {
  const auto turn_a = static_cast<std::int32_t>(size_a);
  const auto turn_b = static_cast<std::int32_t>(size_b);
  Overlap best;
  for (std::int32_t turns = -1; turns <= 1; ++turns) {
    const std::int32_t low = std::max(a.path.front().i, b.path.front().i + turns * turn_a);
    const std::int32_t high = std::min(a.path.back().i, b.path.back().i + turns * turn_a);
    if (high < low) continue;
    const std::int32_t middle = (low + high) / 2;
    const std::int32_t apart = j_at(a.path, middle) - j_at(b.path, middle - turns * turn_a);
    const auto whole = static_cast<std::int32_t>(std::lround(static_cast<double>(apart) / turn_b)) * turn_b;
    if (std::abs(apart - whole) > kSameTrack || high - low + 1 <= best.rows) continue;
    best = {high - low + 1, {turns * turn_a, whole}};
  }
  return best;
}

/// Adds the parts of `other` (moved by `shift`) that lie before and behind the candidate.
void grow(Candidate& candidate, const Candidate& other, const PairedSamples& shift) {
  std::vector<PairedSamples> before;
  std::vector<PairedSamples> behind;
  for (const PairedSamples& p : other.path) {
    const PairedSamples moved{p.i + shift.i, p.j + shift.j};
    if (moved.i < candidate.path.front().i && moved.j <= candidate.path.front().j) before.push_back(moved);
    if (moved.i > candidate.path.back().i && moved.j >= candidate.path.back().j) behind.push_back(moved);
  }
  candidate.path.insert(candidate.path.begin(), before.begin(), before.end());
  candidate.path.insert(candidate.path.end(), behind.begin(), behind.end());
}

}  // namespace

Candidate refine(const Sequences& sequences, const ScaleParameters& parameters,
                 const std::vector<PairedSamples>& around, int band) {
  const std::size_t most = std::min(sequences.a->values.size(), sequences.b->values.size());
  Band dynamic(sequences, parameters, around.front().i, centres_of(around, most), band);
  return dynamic.run(parameters.n_min);
}

Candidate refine_everywhere(const Sequences& sequences, const ScaleParameters& parameters) {
  // Twice around both, so that a pairing over the ends of the sequences is one path.
  const auto around = static_cast<std::int32_t>(sequences.b->values.size());
  const std::vector<std::int32_t> centres(2 * sequences.a->values.size(), around);
  Band dynamic(sequences, parameters, 0, centres, around);
  return dynamic.run(parameters.n_min);
}

void prune_and_merge(std::vector<Candidate>& candidates, std::size_t size_a, std::size_t size_b,
                     std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.discriminant < b.discriminant; });
  if (candidates.size() > most) candidates.resize(most);
  std::vector<Candidate> kept;
  kept.reserve(candidates.size());
  for (Candidate& candidate : candidates) {
    bool merged = false;
    for (Candidate& other : kept) {
      const Overlap common = overlap(other, candidate, size_a, size_b);
      if (common.rows == 0) continue;
      grow(other, candidate, common.shift);
      merged = true;
      break;
    }
    if (!merged) kept.push_back(std::move(candidate));
  }
  candidates = std::move(kept);
}

}  // namespace rejoin::outline::detail
