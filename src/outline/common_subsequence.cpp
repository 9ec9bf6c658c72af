#include "outline/common_subsequence.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::outline {
namespace {

using Word = std::uint64_t;
constexpr std::size_t kBits = 64;

/// For ranges of values the positions in a sequence that hold them, as bits.
class PositionTable {
 public:
  explicit PositionTable(std::span<const float> b) : words_((b.size() + kBits - 1) / kBits) {
    std::vector<std::uint32_t> order(b.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t i, std::uint32_t j) { return b[i] != b[j] ? b[i] < b[j] : i < j; });
    sorted_.reserve(b.size());
    below_.assign((b.size() + 1) * words_, 0);
    for (std::size_t k = 0; k < order.size(); ++k) {
      sorted_.push_back(b[order[k]]);
      std::copy_n(below_.begin() + static_cast<std::ptrdiff_t>(k * words_), words_,
                  below_.begin() + static_cast<std::ptrdiff_t>((k + 1) * words_));
      below_[(k + 1) * words_ + order[k] / kBits] |= Word{1} << (order[k] % kBits);
    }
  }

  std::size_t words() const { return words_; }

  /// Positions of values from low to high.
  void find(float low, float high, Word* mask) const {
    const auto first =
        static_cast<std::size_t>(std::lower_bound(sorted_.begin(), sorted_.end(), low) - sorted_.begin());
    const auto last =
        static_cast<std::size_t>(std::upper_bound(sorted_.begin(), sorted_.end(), high) - sorted_.begin());
    for (std::size_t w = 0; w < words_; ++w)
      mask[w] = below_[last * words_ + w] & ~below_[first * words_ + w];
  }

 private:
  std::size_t words_;
  std::vector<float> sorted_;
  std::vector<Word> below_;  ///< row k: positions of the k least values
};

/// One more value of a: bits of V that turn 0 are columns where the length grows by one.
void advance(const Word* before, const Word* mask, Word* after, std::size_t words) {
  Word carry = 0;
  for (std::size_t w = 0; w < words; ++w) {
    const Word matched = before[w] & mask[w];
    const Word sum = before[w] + matched;
    const Word full = sum + carry;
    carry = static_cast<Word>(sum < before[w]) | static_cast<Word>(full < sum);
    after[w] = full | (before[w] & ~mask[w]);
  }
}

std::vector<float> rotated(std::span<const float> values, std::size_t by) {
  std::vector<float> result;
  result.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result.push_back(values[(i + by) % values.size()]);
  return result;
}

/// The pair in the middle of the shortest stretch, in steps along both sequences, that holds a quarter of the pairs.
std::size_t centre_of(const Pairing& pairs) {
  const std::size_t count = std::max<std::size_t>(2, pairs.size() / 4);
  if (pairs.size() < count) return pairs.size() / 2;
  std::size_t best = 0;
  std::uint32_t least = ~0U;
  for (std::size_t i = 0; i + count <= pairs.size(); ++i) {
    const auto& [a0, b0] = pairs[i];
    const auto& [a1, b1] = pairs[i + count - 1];
    const std::uint32_t extent = (a1 - a0) + (b1 - b0);
    if (extent >= least) continue;
    least = extent;
    best = i + count / 2;
  }
  return best;
}

/// Matches both sequences turned so that they begin at the given positions; pairs in their unturned positions.
Pairing turned_lcs(std::span<const float> a, std::span<const float> b, float tolerance, std::size_t begin_a,
                   std::size_t begin_b) {
  return lcs(rotated(a, begin_a), rotated(b, begin_b), tolerance);
}

}  // namespace

std::size_t lcs_length(std::span<const float> a, std::span<const float> b, float tolerance) {
  if (a.empty() || b.empty()) return 0;
  const PositionTable table(b);
  const std::size_t words = table.words();
  std::vector<Word> row(words, ~Word{0});
  std::vector<Word> mask(words);
  for (const float value : a) {
    table.find(value - tolerance, value + tolerance, mask.data());
    advance(row.data(), mask.data(), row.data(), words);
  }
  std::size_t length = 0;
  for (std::size_t j = 0; j < b.size(); ++j) length += (row[j / kBits] >> (j % kBits) & 1U) == 0 ? 1 : 0;
  return length;
}

Pairing lcs(std::span<const float> a, std::span<const float> b, float tolerance) {
  if (a.empty() || b.empty()) return {};
  const PositionTable table(b);
  const std::size_t words = table.words();
  std::vector<Word> rows((a.size() + 1) * words, ~Word{0});
  std::vector<Word> mask(words);
  for (std::size_t i = 0; i < a.size(); ++i) {
    table.find(a[i] - tolerance, a[i] + tolerance, mask.data());
    advance(rows.data() + i * words, mask.data(), rows.data() + (i + 1) * words, words);
  }
  // Back from the corner: a column that adds nothing in this row is dropped, and so is a row that adds nothing there.
  const auto adds = [&](std::size_t i, std::size_t j) {
    return (rows[i * words + (j - 1) / kBits] >> ((j - 1) % kBits) & 1U) == 0;
  };
  Pairing pairs;
  std::size_t i = a.size();
  for (std::size_t j = b.size(); i > 0 && j > 0;) {
    if (!adds(i, j)) {
      --j;
    } else if (adds(i - 1, j)) {
      --i;
    } else {
      --i;
      --j;
      pairs.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
  }
  std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<float> in_order(std::span<const float> b, Order order) {
  std::vector<float> result(b.begin(), b.end());
  if (order == Order::Reversed || order == Order::ReversedNegated) std::reverse(result.begin(), result.end());
  if (order == Order::Negated || order == Order::ReversedNegated) {
    for (float& value : result) value = -value;
  }
  return result;
}

CyclicMatch cyclic_lcs(std::span<const float> a, std::span<const float> b, float tolerance, Order order) {
  CyclicMatch match{order, {}, 0};
  if (a.empty() || b.empty()) return match;
  const std::vector<float> ordered = in_order(b, order);
  std::size_t most = 0;
  std::pair<std::size_t, std::size_t> begin{0, 0};
  for (const std::size_t begin_a : {std::size_t{0}, a.size() / 2}) {
    for (const std::size_t begin_b : {std::size_t{0}, ordered.size() / 2}) {
      const std::size_t length = lcs_length(rotated(a, begin_a), rotated(ordered, begin_b), tolerance);
      if (length <= most) continue;
      most = length;
      begin = {begin_a, begin_b};
    }
  }
  const Pairing first = turned_lcs(a, ordered, tolerance, begin.first, begin.second);
  if (first.empty()) return match;
  const auto& [centre_a, centre_b] = first[centre_of(first)];
  const std::size_t begin_a = (begin.first + centre_a + a.size() - a.size() / 2) % a.size();
  const std::size_t begin_b = (begin.second + centre_b + b.size() - b.size() / 2) % b.size();
  match.pairs = turned_lcs(a, ordered, tolerance, begin_a, begin_b);
  match.centre = centre_of(match.pairs);
  const bool back = order == Order::Reversed || order == Order::ReversedNegated;
  for (auto& [in_a, in_b] : match.pairs) {
    in_a = static_cast<std::uint32_t>((in_a + begin_a) % a.size());
    in_b = static_cast<std::uint32_t>((in_b + begin_b) % b.size());
    if (back) in_b = static_cast<std::uint32_t>(b.size()) - 1 - in_b;
  }
  return match;
}

CyclicMatch cyclic_lcs(std::span<const float> a, std::span<const float> b, float tolerance) {
  CyclicMatch best;
  for (const Order order : kOrders) {
    CyclicMatch match = cyclic_lcs(a, b, tolerance, order);
    if (match.pairs.size() > best.pairs.size()) best = std::move(match);
  }
  return best;
}

}  // namespace rejoin::outline
