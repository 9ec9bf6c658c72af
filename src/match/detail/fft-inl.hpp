/// Discrete Fourier transforms of many lines in step, a vector lane each (compiled once an instruction set).
///
/// No multiplication is fused with an addition, and no lane sees another, so the bits are the same on every
/// processor.

#if defined(REJOIN_MATCH_FFT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef REJOIN_MATCH_FFT_INL
#undef REJOIN_MATCH_FFT_INL
#else
#define REJOIN_MATCH_FFT_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "match/detail/fft_plan.hpp"

HWY_BEFORE_NAMESPACE();
namespace rejoin::match::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lines that are transformed in step, at most.
constexpr std::size_t kMostLines = 16;
using Tag = hn::CappedTag<float, kMostLines>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t kLines = hn::MaxLanes(Tag());

/// A complex number of each line.
struct Complexes {
  Vector re;
  Vector im;
};

HWY_INLINE Complexes operator+(const Complexes& a, const Complexes& b) {
  return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}
HWY_INLINE Complexes operator-(const Complexes& a, const Complexes& b) {
  return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}
HWY_INLINE Complexes operator*(const Complexes& a, Vector b) {
  return {hn::Mul(a.re, b), hn::Mul(a.im, b)};
}
HWY_INLINE Complexes operator*(const Complexes& a, const Complexes& b) {
  return {hn::Sub(hn::Mul(a.re, b.re), hn::Mul(a.im, b.im)),
          hn::Add(hn::Mul(a.re, b.im), hn::Mul(a.im, b.re))};
}
/// a * conj(b)
HWY_INLINE Complexes times_conjugate(const Complexes& a, const Complexes& b) {
  return {hn::Add(hn::Mul(a.re, b.re), hn::Mul(a.im, b.im)),
          hn::Sub(hn::Mul(a.im, b.re), hn::Mul(a.re, b.im))};
}
/// -i * a
HWY_INLINE Complexes turned_back(const Complexes& a) {
  return {a.im, hn::Neg(a.re)};
}

template <int Radix>
HWY_INLINE void butterfly(Complexes (&x)[Radix]) {
  const Tag d;
  if constexpr (Radix == 2) {
    const Complexes sum = x[0] + x[1];
    x[1] = x[0] - x[1];
    x[0] = sum;
  } else if constexpr (Radix == 3) {
    const Complexes sum = x[1] + x[2];
    const Complexes side = turned_back((x[1] - x[2]) * hn::Set(d, 0.8660254037844386F));  // sin 120
    const Complexes middle = x[0] - sum * hn::Set(d, 0.5F);
    x[0] = x[0] + sum;
    x[1] = middle + side;
    x[2] = middle - side;
  } else if constexpr (Radix == 4) {
    const Complexes even_sum = x[0] + x[2];
    const Complexes even_difference = x[0] - x[2];
    const Complexes odd_sum = x[1] + x[3];
    const Complexes odd_difference = turned_back(x[1] - x[3]);
    x[0] = even_sum + odd_sum;
    x[1] = even_difference + odd_difference;
    x[2] = even_sum - odd_sum;
    x[3] = even_difference - odd_difference;
  } else {
    static_assert(Radix == 5);
    const auto cos1 = hn::Set(d, 0.30901699437494745F);  // cos 72, cos 144, sin 72, sin 144
    const auto cos2 = hn::Set(d, -0.8090169943749475F);
    const auto sin1 = hn::Set(d, 0.9510565162951535F);
    const auto sin2 = hn::Set(d, 0.5877852522924731F);
    const Complexes sum1 = x[1] + x[4];
    const Complexes sum2 = x[2] + x[3];
    const Complexes difference1 = turned_back(x[1] - x[4]);
    const Complexes difference2 = turned_back(x[2] - x[3]);
    const Complexes middle1 = x[0] + (sum1 * cos1 + sum2 * cos2);
    const Complexes middle2 = x[0] + (sum1 * cos2 + sum2 * cos1);
    const Complexes side1 = difference1 * sin1 + difference2 * sin2;
    const Complexes side2 = difference1 * sin2 - difference2 * sin1;
    x[0] = x[0] + (sum1 + sum2);
    x[1] = middle1 + side1;
    x[2] = middle2 + side2;
    x[3] = middle2 - side2;
    x[4] = middle1 - side1;
  }
}

/// The t-th numbers of kLines lines side by side: real parts, then imaginary ones.
struct Buffer {
  float* at;

  HWY_INLINE Complexes get(std::size_t t) const {
    const Tag d;
    const float* from = at + t * (2 * kLines);
    return {hn::Load(d, from), hn::Load(d, from + kLines)};
  }
  HWY_INLINE void put(std::size_t t, const Complexes& value) const {
    const Tag d;
    float* to = at + t * (2 * kLines);
    hn::Store(value.re, d, to);
    hn::Store(value.im, d, to + kLines);
  }
};

/// The same in two fields, the t-th numbers in the t-th row.
struct Rows {
  float* re;
  float* im;
  std::size_t stride;

  HWY_INLINE Complexes get(std::size_t t) const {
    const Tag d;
    return {hn::LoadU(d, re + t * stride), hn::LoadU(d, im + t * stride)};
  }
  HWY_INLINE void put(std::size_t t, const Complexes& value) const {
    const Tag d;
    hn::StoreU(value.re, d, re + t * stride);
    hn::StoreU(value.im, d, im + t * stride);
  }
};

/// `count` numbers, then zeros.
template <class In>
struct FilledUp {
  In in;
  std::size_t count;

  HWY_INLINE Complexes get(std::size_t t) const {
    const Tag d;
    return t < count ? in.get(t) : Complexes{hn::Zero(d), hn::Zero(d)};
  }
};

template <int Radix, class In, class Out>
HWY_INLINE void run_stage(const FftPlan& plan, const FftStage& stage, const In& in, const Out& out) {
  const Tag d;
  constexpr std::size_t kPerGroup = std::size_t{2} * (Radix - 1);
  const float* twiddle = plan.twiddles.data() + stage.twiddles;
  for (std::size_t p = 0; p < stage.groups; ++p, twiddle += kPerGroup) {
    for (std::size_t q = 0; q < stage.stride; ++q) {
      Complexes x[Radix];
      for (int k = 0; k < Radix; ++k)
        x[k] = in.get(q + stage.stride * (p + stage.groups * static_cast<std::size_t>(k)));
      butterfly(x);
      const std::size_t to = q + stage.stride * Radix * p;
      out.put(to, x[0]);
      for (int k = 1; k < Radix; ++k) {
        if (p != 0) x[k] = x[k] * Complexes{hn::Set(d, twiddle[2 * k - 2]), hn::Set(d, twiddle[2 * k - 1])};
        out.put(to + stage.stride * static_cast<std::size_t>(k), x[k]);
      }
    }
  }
}

template <class In, class Out>
HWY_INLINE void run_any_stage(const FftPlan& plan, const FftStage& stage, const In& in, const Out& out) {
  switch (stage.radix) {
    case 2:
      run_stage<2>(plan, stage, in, out);
      break;
    case 3:
      run_stage<3>(plan, stage, in, out);
      break;
    case 4:
      run_stage<4>(plan, stage, in, out);
      break;
    default:
      run_stage<5>(plan, stage, in, out);
      break;
  }
}

// Not inlined, as each is long and every transform ends in them.
HWY_NOINLINE void run_inner_stage(const FftPlan& plan, const FftStage& stage, Buffer in, Buffer out) {
  run_any_stage(plan, stage, in, out);
}
HWY_NOINLINE void run_last_stage(const FftPlan& plan, Buffer in, Rows out) {
  run_any_stage(plan, plan.stages.back(), in, out);
}

/// Transforms kLines lines.
/// \param in       get(t) gives their t-th numbers, each asked for once
/// \param out      row f takes their values at frequency f
/// \param scratch  two aligned buffers of plan.length * 2 * kLines floats; `in` may read the second
template <class In>
HWY_INLINE void transform_lines(const FftPlan& plan, const In& in, const Rows& out,
                                float* const (&scratch)[2]) {
  run_stage<4>(plan, plan.stages.front(), in, Buffer{scratch[0]});
  std::size_t here = 0;
  for (std::size_t s = 1; s + 1 < plan.stages.size(); ++s, here = 1 - here) {
    run_inner_stage(plan, plan.stages[s], Buffer{scratch[here]}, Buffer{scratch[1 - here]});
  }
  run_last_stage(plan, Buffer{scratch[here]}, out);
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void transpose(const float* from, std::size_t /*stride*/, std::size_t count, float* to,
                          std::size_t step) {
  for (std::size_t t = 0; t < count; ++t) to[t * step] = from[t];
}

#else

/// Four numbers each of the rows first, first + 4, first + 8, ...
template <class D>
HWY_INLINE hn::Vec<D> blocks_of_rows(D d, const float* first, std::size_t stride) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, first);
  } else {
    const hn::Half<D> half;
    const std::size_t rows = hn::MaxLanes(half);
    return hn::Combine(d, blocks_of_rows(half, first + rows * stride, stride),
                       blocks_of_rows(half, first, stride));
  }
}

/// Puts the t-th numbers of kLines rows side by side at to + t * step, for t < count and up to 3 more.
HWY_INLINE void transpose(const float* from, std::size_t stride, std::size_t count, float* to,
                          std::size_t step) {
  const Tag d;
  const hn::Repartition<double, Tag> pairs;
  for (std::size_t t = 0; t < count; t += 4) {
    const auto row0 = blocks_of_rows(d, from + t, stride);
    const auto row1 = blocks_of_rows(d, from + t + stride, stride);
    const auto row2 = blocks_of_rows(d, from + t + 2 * stride, stride);
    const auto row3 = blocks_of_rows(d, from + t + 3 * stride, stride);
    const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, row0, row1));
    const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, row2, row3));
    const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, row0, row1));
    const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, row2, row3));
    float* at = to + t * step;
    hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23)), d, at);
    hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23)), d, at + step);
    hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23)), d, at + 2 * step);
    hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23)), d, at + 3 * step);
  }
}

#endif

}  // namespace rejoin::match::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
