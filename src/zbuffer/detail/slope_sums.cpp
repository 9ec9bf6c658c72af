#include "zbuffer/detail/slope_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/detail/slope_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rejoin::zbuffer::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Columns are taken in blocks of 16 on every processor, and the k-th of each block adds to the k-th of 16
/// sums.  So the order of the additions, and with it the bits of the result, does not depend on how many
/// lanes a vector has.
constexpr int kBlock = 16;
/// Rows that a float accumulates before it is added to a double: at most 8 * 2048 / 16 terms.
constexpr int kRowsPerFlush = 8;
using Tag = hn::CappedTag<float, kBlock>;
using Vector = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

struct Maps {
  const float* a;
  const float* b;
  int width;
  int height;
};

/// |Du d1 + Du d2| + |Dv d1 + Dv d2| and where either map has both differences.  Background is not finite,
/// which shows in the differences: inf - x, inf - inf and NaN - x are all NaN or above every float.
struct Terms {
  Vector sum;
  Mask in_a;
  Mask in_b;
};

/// \param a  row of the first map at its first column
/// \param b  row of the second map at the mirror of that column
HWY_INLINE Terms terms_at(const float* a, const float* b, int width) {
  const Tag d;
  const auto largest = hn::Set(d, std::numeric_limits<float>::max());
  const auto mirror = [&](const float* last)
                          HWY_ATTR { return hn::Reverse(d, hn::LoadU(d, last - (hn::Lanes(d) - 1))); };
  const auto here_a = hn::LoadU(d, a);
  const auto here_b = mirror(b);
  const auto a_u = hn::Sub(hn::LoadU(d, a + 1), here_a);
  const auto a_v = hn::Sub(hn::LoadU(d, a + width), here_a);
  const auto b_u = hn::Sub(mirror(b - 1), here_b);
  const auto b_v = hn::Sub(mirror(b + width), here_b);
  return {hn::Add(hn::Abs(hn::Add(a_u, b_u)), hn::Abs(hn::Add(a_v, b_v))),
          hn::Le(hn::Add(hn::Abs(a_u), hn::Abs(a_v)), largest),
          hn::Le(hn::Add(hn::Abs(b_u), hn::Abs(b_v)), largest)};
}

/// Sums over some rows of the columns that fall to lanes first_lane and following of their block.
struct Accumulator {
  Vector sum;
  std::size_t overlap = 0;
  std::size_t covered_a = 0;
  std::size_t covered_b = 0;

  HWY_INLINE void add(const Terms& terms, Mask counted) {
    const Tag d;
    const auto in_a = hn::And(terms.in_a, counted);
    const auto in_b = hn::And(terms.in_b, counted);
    const auto both = hn::And(in_a, in_b);
    sum = hn::Add(sum, hn::IfThenElseZero(both, terms.sum));
    overlap += hn::CountTrue(d, both);
    covered_a += hn::CountTrue(d, in_a);
    covered_b += hn::CountTrue(d, in_b);
  }
};

HWY_INLINE void add_row(const Maps& maps, int row, int first_lane, Accumulator& to) {
  const Tag d;
  const float* a = maps.a + static_cast<std::ptrdiff_t>(row) * maps.width;
  const float* b = maps.b + static_cast<std::ptrdiff_t>(row) * maps.width + maps.width - 1;
  const int columns = maps.width - 1;
  const auto all = hn::FirstN(d, kBlock);
  int i = first_lane;
  for (; i + kBlock <= columns + first_lane; i += kBlock) to.add(terms_at(a + i, b - i, maps.width), all);
  const int left = columns % kBlock;
  if (left == 0) return;
  // The last block is moved back into the row; its first lanes were counted before.
  const int moved = columns - kBlock + first_lane;
  const auto fresh =
      hn::Not(hn::FirstN(d, static_cast<std::size_t>(std::max(0, kBlock - left - first_lane))));
  to.add(terms_at(a + moved, b - moved, maps.width), fresh);
}

/// \pre maps.width > kBlock
SlopeSums sum_in_vectors(const float* a, const float* b, int width, int height) {
  const Maps maps{a, b, width, height};
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  double sums[kBlock] = {};
  SlopeSums result;
  for (int top = 0; top + 1 < height; top += kRowsPerFlush) {
    const int bottom = std::min(top + kRowsPerFlush, height - 1);
    for (int lane = 0; lane < kBlock; lane += lanes) {
      Accumulator part{.sum = hn::Zero(d)};
      for (int row = top; row < bottom; ++row) add_row(maps, row, lane, part);
      HWY_ALIGN float values[kBlock];
      hn::Store(part.sum, d, values);
      for (int k = 0; k < lanes; ++k) sums[lane + k] += static_cast<double>(values[k]);
      result.overlap += static_cast<int>(part.overlap);
      result.covered_a += static_cast<int>(part.covered_a);
      result.covered_b += static_cast<int>(part.covered_b);
    }
  }
  for (const double sum : sums) result.sum += sum;
  return result;
}

}  // namespace rejoin::zbuffer::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::zbuffer::detail {

HWY_EXPORT(sum_in_vectors);

SlopeSums slope_sums(const float* a, const float* b, int width, int height) {
  constexpr int kNarrow = 16;  // a row without one whole block
  if (width <= kNarrow) return slope_sums_scalar(a, b, width, height);
  return HWY_DYNAMIC_DISPATCH(sum_in_vectors)(a, b, width, height);
}

SlopeSums slope_sums_scalar(const float* a, const float* b, int width, int height) {
  SlopeSums sums;
  for (int j = 0; j + 1 < height; ++j) {
    const float* row_a = a + static_cast<std::ptrdiff_t>(j) * width;
    const float* row_b = b + static_cast<std::ptrdiff_t>(j) * width;
    for (int i = 0; i + 1 < width; ++i) {
      const int m = width - 1 - i;
      const double a_u = static_cast<double>(row_a[i + 1]) - row_a[i];
      const double a_v = static_cast<double>(row_a[i + width]) - row_a[i];
      const double b_u = static_cast<double>(row_b[m - 1]) - row_b[m];
      const double b_v = static_cast<double>(row_b[m + width]) - row_b[m];
      const bool in_a = std::isfinite(a_u) && std::isfinite(a_v);
      const bool in_b = std::isfinite(b_u) && std::isfinite(b_v);
      sums.covered_a += in_a ? 1 : 0;
      sums.covered_b += in_b ? 1 : 0;
      if (in_a && in_b) {
        ++sums.overlap;
        sums.sum += std::abs(a_u + b_u) + std::abs(a_v + b_v);
      }
    }
  }
  return sums;
}

}  // namespace rejoin::zbuffer::detail
#endif
