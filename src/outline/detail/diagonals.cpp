#include "outline/detail/diagonals.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "outline/detail/diagonals.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef REJOIN_OUTLINE_DIAGONALS
#define REJOIN_OUTLINE_DIAGONALS
namespace rejoin::outline::detail {

inline constexpr std::size_t kMostLanes = 16;  // diagonals at a time
inline constexpr double kDrop =
    6.0;  // a stretch ends where it has lost as much as this many perfect samples give

/// The two sequences without wrap, and what is looked for on their diagonals.
struct Diagonals {
  Sequence a;
  Sequence b;               ///< with kMostLanes samples to spare
  std::int32_t count;       ///< samples of a diagonal
  std::int32_t last_start;  ///< no stretch begins from here on
  std::int32_t diagonals;   ///< they begin at a's first sample and each of b's first ones
  StretchRule rule;

  void add(std::int32_t begin, std::int32_t end, float gain, std::int32_t first_j,
           std::vector<Stretch>& found) const {
    if (end - begin < rule.least || gain <= rule.least_gain) return;
    found.push_back({begin, first_j + begin, end - begin, gain});
  }
};

}  // namespace rejoin::outline::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace rejoin::outline::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kMostLanes>;
using Ints = hn::RebindToSigned<Floats>;

/// Where the stretches of some neighbouring diagonals stand.
struct Front {
  hn::Vec<Floats> best;
  hn::Vec<Ints> begin;
  hn::Vec<Ints> end;

  /// Adds what the chosen lanes have found.
  void add(const Diagonals& all, std::int32_t first_j, hn::Mask<Floats> chosen,
           std::vector<Stretch>& found) const {
    std::array<float, kMostLanes> gains;
    std::array<std::int32_t, kMostLanes> begins;
    std::array<std::int32_t, kMostLanes> ends;
    hn::StoreU(hn::IfThenElseZero(chosen, best), Floats(), gains.data());
    hn::StoreU(begin, Ints(), begins.data());
    hn::StoreU(end, Ints(), ends.data());
    for (std::size_t lane = 0; lane < hn::Lanes(Floats()); ++lane) {
      if (gains[lane] > 0.0F)
        all.add(begins[lane], ends[lane], gains[lane], first_j + static_cast<std::int32_t>(lane), found);
    }
  }
};

/// The diagonals from first_j on, one a lane.
void scan(const Diagonals& all, std::int32_t first_j, std::vector<Stretch>& found) {
  const Floats f;
  const Ints n;
  const float* values_b = all.b.values.data() + first_j;
  const float* relief_b = all.b.relief.data() + first_j;
  const auto xi2 = hn::Set(f, static_cast<float>(all.rule.xi2));
  const auto drop = hn::Set(f, static_cast<float>(kDrop * all.rule.xi2));
  const auto least_gain = hn::Set(f, static_cast<float>(all.rule.least_gain));
  const auto zero = hn::Zero(f);
  auto open = hn::FirstN(f, static_cast<std::size_t>(all.diagonals - first_j));
  auto gain = zero;
  Front front{zero, hn::Zero(n), hn::Zero(n)};
  for (std::int32_t t = 0; t < all.count; ++t) {
    const auto k = static_cast<std::size_t>(t);
    const auto d = hn::Sub(hn::Set(f, all.a.values[k]), hn::LoadU(f, values_b + k));
    const auto allowed = hn::Mul(hn::Mul(xi2, hn::Set(f, all.a.relief[k])), hn::LoadU(f, relief_b + k));
    gain = hn::Add(gain, hn::Sub(allowed, hn::Mul(d, d)));
    const auto better = hn::Gt(gain, front.best);
    const auto next = hn::Set(n, t + 1);
    front.best = hn::IfThenElse(better, gain, front.best);
    front.end = hn::IfThenElse(hn::RebindMask(n, better), next, front.end);
    const auto fallen = hn::Or(hn::Le(gain, zero), hn::Lt(gain, hn::Sub(front.best, drop)));
    const auto ended = hn::AndNot(better, fallen);
    const auto told = hn::And(hn::And(ended, open), hn::Ge(front.best, least_gain));
    if (!hn::AllFalse(f, told)) front.add(all, first_j, told, found);
    gain = hn::IfThenZeroElse(ended, gain);
    front.best = hn::IfThenZeroElse(ended, front.best);
    front.begin = hn::IfThenElse(hn::RebindMask(n, ended), next, front.begin);
    front.end = hn::IfThenElse(hn::RebindMask(n, ended), next, front.end);
    if (t < all.last_start) continue;
    open = hn::AndNot(ended, open);
    if (hn::AllFalse(f, open)) return;
  }
  front.add(all, first_j, open, found);
}

void scan_all(const Diagonals& all, std::vector<Stretch>& found) {
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(Floats()));
  for (std::int32_t j = 0; j < all.diagonals; j += lanes) scan(all, j, found);
}

}  // namespace rejoin::outline::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::outline::detail {
namespace {

HWY_EXPORT(scan_all);

/// The sequence gone round until it has `length` samples or more.
Sequence unrolled(const Sequence& sequence, std::size_t length) {
  Sequence result;
  while (result.values.size() < length) {
    result.values.insert(result.values.end(), sequence.values.begin(), sequence.values.end());
    result.relief.insert(result.relief.end(), sequence.relief.begin(), sequence.relief.end());
  }
  return result;
}

}  // namespace

std::vector<Stretch> find_stretches(const Sequences& sequences, const StretchRule& rule) {
  const auto size_a = static_cast<std::int32_t>(sequences.a->values.size());
  const auto size_b = static_cast<std::int32_t>(sequences.b->values.size());
  const std::int32_t count = size_a + std::min(size_a, size_b);
  const auto length = static_cast<std::size_t>(count);
  const Diagonals all{unrolled(*sequences.a, length),
                      unrolled(*sequences.b, length + sequences.b->values.size() + kMostLanes),
                      count,
                      size_a,
                      size_b,
                      rule};
  std::vector<Stretch> found;
  HWY_DYNAMIC_DISPATCH(scan_all)(all, found);
  for (Stretch& s : found) s.length = std::min({s.length, size_a, size_b});
  return found;
}

}  // namespace rejoin::outline::detail
#endif
