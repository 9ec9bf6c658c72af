#include "outline/detail/local_alignment.hpp"

#include <algorithm>
#include <cmath>

#include "core/cyclic.hpp"

namespace rejoin::outline::detail {
namespace {

/// A cell's score above, and the cell where its alignment began below, so that one comparison carries both.
using Packed = std::int64_t;
constexpr int kScoreShift = 32;
constexpr int kRowShift = 16;

Packed fresh(std::size_t i, std::size_t j) {
  return static_cast<Packed>(i << kRowShift | j);
}
int score_of(Packed cell) {
  return static_cast<int>(cell >> kScoreShift);
}

/// Half of the sequence again at its end, so that no stretch of half of it is cut.
std::vector<std::uint8_t> extended(std::span<const std::uint8_t> values) {
  std::vector<std::uint8_t> result(values.begin(), values.end());
  result.insert(result.end(), values.begin(),
                values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return result;
}

struct End {
  Packed cell = 0;
  std::uint32_t row = 0;
  std::uint32_t column = 0;
};

class Aligner {
 public:
  Aligner(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, const TurnModel& model,
          const LocalOptions& options)
      : size_a_(a.size()),
        size_b_(b.size()),
        model_(model),
        options_(options),
        gap_(static_cast<Packed>(options.skip) << kScoreShift),
        a_(extended(a)),
        b_(extended(b)) {}

  std::vector<LocalMatch> run() {
    fill();
    std::vector<LocalMatch> found;
    for (const End& end : best_ends()) found.push_back(trace(end));
    return found;
  }

 private:
  static Packed cell_of(int score) { return static_cast<Packed>(score) * (Packed{1} << kScoreShift); }

  /// The best end in every row and in every column.
  void fill() {
    std::vector<Packed> row(b_.size() + 1);
    std::vector<End> columns(b_.size());
    ends_.reserve(a_.size() + b_.size());
    for (std::size_t j = 0; j <= b_.size(); ++j) row[j] = fresh(0, j);
    for (std::size_t i = 0; i < a_.size(); ++i) {
      Packed diagonal = row[0];
      row[0] = fresh(i + 1, 0);
      End best{0, static_cast<std::uint32_t>(i), 0};
      const std::int16_t* scores = model_.row(a_[i]);
      for (std::size_t j = 0; j < b_.size(); ++j) {
        Packed cell = std::max(diagonal + cell_of(scores[b_[j]]), std::max(row[j], row[j + 1]) - gap_);
        if (score_of(cell) <= 0) cell = fresh(i + 1, j + 1);
        diagonal = row[j + 1];
        row[j + 1] = cell;
        if (cell > best.cell) best = {cell, best.row, static_cast<std::uint32_t>(j)};
        if (cell > columns[j].cell) columns[j] = {cell, best.row, static_cast<std::uint32_t>(j)};
      }
      ends_.push_back(best);
    }
    ends_.insert(ends_.end(), columns.begin(), columns.end());
  }

  /// Two alignments are one if they run along the same cells: near each other on the diagonal and in the same place.
  bool same(const End& x, const End& y) const {
    const auto off = [](std::int64_t d, std::size_t n) {
      const std::size_t ahead = wrapped(d, n);
      return static_cast<std::int64_t>(std::min(ahead, n - ahead));
    };
    const std::int64_t rows = off(static_cast<std::int64_t>(x.row) - y.row, size_a_);
    const std::int64_t shift = std::abs((static_cast<std::int64_t>(x.row) - x.column) -
                                        (static_cast<std::int64_t>(y.row) - y.column));
    const std::int64_t across = std::min({shift, off(shift, size_a_), off(shift, size_b_)});
    const auto begin_x = static_cast<std::int64_t>(x.cell >> kRowShift & 0xffff);
    return across <= 12 && rows <= static_cast<std::int64_t>(x.row) - begin_x + 12;
  }

  std::vector<End> best_ends() const {
    std::vector<End> sorted = ends_;
    std::sort(sorted.begin(), sorted.end(), [](const End& x, const End& y) {
      if (score_of(x.cell) != score_of(y.cell)) return score_of(x.cell) > score_of(y.cell);
      return x.row != y.row ? x.row < y.row : x.column < y.column;
    });
    std::vector<End> kept;
    for (const End& end : sorted) {
      if (kept.size() == options_.most || score_of(end.cell) < options_.least) break;
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const End& other) {
        return (other.cell & 0xffffffff) == (end.cell & 0xffffffff) || same(other, end);
      });
      if (!known) kept.push_back(end);
    }
    return kept;
  }

  /// Aligns the stretch between an alignment's two ends once more, and walks back.
  LocalMatch trace(const End& end) const {
    const auto first_row = static_cast<std::size_t>(end.cell >> kRowShift & 0xffff);
    const auto first_column = static_cast<std::size_t>(end.cell & 0xffff);
    const std::size_t rows = end.row + 1 - first_row;
    const std::size_t columns = end.column + 1 - first_column;
    enum : std::uint8_t { kMatch, kSkipA, kSkipB };
    std::vector<std::uint8_t> steps((rows + 1) * (columns + 1), kMatch);
    std::vector<Packed> row(columns + 1);
    for (std::size_t j = 0; j <= columns; ++j) row[j] = -gap_ * static_cast<Packed>(j);
    for (std::size_t i = 1; i <= rows; ++i) {
      Packed diagonal = row[0];
      row[0] = -gap_ * static_cast<Packed>(i);
      for (std::size_t j = 1; j <= columns; ++j) {
        const Packed match =
            diagonal + cell_of(model_.score(a_[first_row + i - 1], b_[first_column + j - 1]));
        const Packed skip_a = row[j] - gap_;
        const Packed skip_b = row[j - 1] - gap_;
        diagonal = row[j];
        row[j] = std::max(match, std::max(skip_a, skip_b));
        steps[i * (columns + 1) + j] = row[j] == match ? kMatch : row[j] == skip_a ? kSkipA : kSkipB;
      }
    }
    LocalMatch result{{}, score_of(end.cell)};
    for (std::size_t i = rows, j = columns; i > 0 && j > 0;) {
      const std::uint8_t step = steps[i * (columns + 1) + j];
      if (step != kSkipB) --i;
      if (step != kSkipA) --j;
      if (step != kMatch || model_.score(a_[first_row + i], b_[first_column + j]) <= 0) continue;
      result.pairs.emplace_back(static_cast<std::uint32_t>((first_row + i) % size_a_),
                                static_cast<std::uint32_t>((first_column + j) % size_b_));
    }
    std::reverse(result.pairs.begin(), result.pairs.end());
    return result;
  }

  std::size_t size_a_;
  std::size_t size_b_;
  const TurnModel& model_;
  LocalOptions options_;
  Packed gap_;
  std::vector<std::uint8_t> a_;
  std::vector<std::uint8_t> b_;
  std::vector<End> ends_;
};

}  // namespace

std::vector<LocalMatch> local_alignments(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                                         const TurnModel& model, const LocalOptions& options) {
  if (a.empty() || b.empty()) return {};
  return Aligner(a, b, model, options).run();
}

}  // namespace rejoin::outline::detail
