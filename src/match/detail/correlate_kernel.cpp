#include "match/detail/correlate_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "match/detail/correlate_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/angle.hpp"
#include "match/detail/fft-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace rejoin::match::detail::HWY_NAMESPACE {

using Mask = hn::Mask<Tag>;

HWY_INLINE Complexes load(const ComplexField& field, std::size_t place) {
  const Tag d;
  return {hn::LoadU(d, field.re.data() + place), hn::LoadU(d, field.im.data() + place)};
}

// The products whose inverse transforms are the sums.  Real and imaginary part change places, which makes a forward
// transform an inverse one whose results have changed places too.
struct Products {
  const CorrelateFields& fields;
  std::size_t column;
  std::size_t at(std::size_t row) const { return row * fields.spectrum_stride + column; }
};
struct PixelsAndEnergy : Products {
  HWY_INLINE Complexes get(std::size_t row) const {
    const std::size_t f = at(row);
    const Complexes own = times_conjugate(load(fields.first.packed, f), load(fields.second.mask, f));
    const Complexes others = times_conjugate(load(fields.first.mask, f), load(fields.second.energy, f));
    return {hn::Add(own.im, others.re), hn::Sub(own.re, others.im)};
  }
};
template <ComplexField Spectra::*First, ComplexField Spectra::*Second>
struct Product : Products {
  HWY_INLINE Complexes get(std::size_t row) const {
    const std::size_t f = at(row);
    const Complexes product = times_conjugate(load(fields.first.*First, f), load(fields.second.*Second, f));
    return {product.im, product.re};
  }
};
using FirstSlopes = Product<&Spectra::slopes, &Spectra::mask>;
using SecondSlopes = Product<&Spectra::mask, &Spectra::slopes>;
struct TogetherAndAlong : Products {
  template <ComplexField Spectra::*Which>
  HWY_INLINE Complexes product(std::size_t f) const {
    return times_conjugate(load(fields.first.*Which, f), load(fields.second.*Which, f));
  }
  HWY_INLINE Complexes get(std::size_t row) const {
    const Tag d;
    const std::size_t f = at(row);
    const auto slope = [&](const BorderFilter& filter) { return filter.slope.data(); };
    const auto mean = [&](const BorderFilter& filter) { return filter.mean.data(); };
    const auto power = hn::Add(hn::Mul(hn::Set(d, slope(fields.along_u->border)[row]),
                                       hn::LoadU(d, mean(fields.along_v->border) + column)),
                               hn::Mul(hn::Set(d, mean(fields.along_u->border)[row]),
                                       hn::LoadU(d, slope(fields.along_v->border) + column)));
    const Complexes together = product<&Spectra::slope_u>(f) + product<&Spectra::slope_v>(f);
    const Complexes along = product<&Spectra::mask>(f) * power;
    return {hn::Add(together.im, along.re), hn::Sub(together.re, along.im)};
  }
};

struct Scratch {
  float* swing[2];
  explicit Scratch(const CorrelateFields& fields)
      : swing{fields.scratch[0].data(), fields.scratch[1].data()} {}
};

/// Transforms a map's two fields, x + iy, of width x height.
void transform_fields(const CorrelateFields& fields, const float* x, const float* y, std::size_t width,
                      std::size_t height, const ComplexField& to) {
  const std::size_t row = fields.map_stride;
  const std::size_t frequencies = fields.spectrum_stride;
  const ComplexField& half = fields.half[0];
  const Scratch scratch(fields);
  for (std::size_t u = 0; u < width; u += kLines) {
    const Rows in{const_cast<float*>(x) + u, const_cast<float*>(y) + u, row};
    const Rows out{half.re.data() + u, half.im.data() + u, row};
    transform_lines(fields.along_v->plan, FilledUp<Rows>{in, height}, out, scratch.swing);
  }
  for (std::size_t v = 0; v < fields.size.height; v += kLines) {
    transpose(half.re.data() + v * row, row, width, scratch.swing[1], 2 * kLines);
    transpose(half.im.data() + v * row, row, width, scratch.swing[1] + kLines, 2 * kLines);
    const Rows out{to.re.data() + v, to.im.data() + v, frequencies};
    transform_lines(fields.along_u->plan, FilledUp<Buffer>{{scratch.swing[1]}, width}, out, scratch.swing);
  }
  // The frequency after the last is the first again, for those who read backwards.
  for (std::size_t u = 0; u < fields.size.width; ++u) {
    for (float* line : {to.re.data() + u * frequencies, to.im.data() + u * frequencies})
      line[fields.size.height] = line[0];
  }
}

/// Spectra of two real fields from that of x + iy: X = (Z(f) + conj Z(-f)) / 2, Y = (Z(f) - conj Z(-f)) / 2i.
void unpack(const CorrelateFields& fields, const ComplexField& both, const ComplexField& x,
            const ComplexField& y) {
  const Tag d;
  const auto half = hn::Set(d, 0.5F);
  const std::size_t stride = fields.spectrum_stride;
  const std::size_t height = fields.size.height;
  for (std::size_t u = 0; u < fields.size.width; ++u) {
    const std::size_t back_u = u == 0 ? 0 : fields.size.width - u;
    for (std::size_t v = 0; v < height; v += kLines) {
      const std::size_t f = u * stride + v;
      const auto back =
          static_cast<std::ptrdiff_t>(back_u * stride + height) - static_cast<std::ptrdiff_t>(v + kLines - 1);
      const Complexes z = load(both, f);
      const auto back_re = hn::Reverse(d, hn::LoadU(d, both.re.data() + back));
      const auto back_im = hn::Reverse(d, hn::LoadU(d, both.im.data() + back));
      hn::StoreU(hn::Mul(hn::Add(z.re, back_re), half), d, x.re.data() + f);
      hn::StoreU(hn::Mul(hn::Sub(z.im, back_im), half), d, x.im.data() + f);
      hn::StoreU(hn::Mul(hn::Add(z.im, back_im), half), d, y.re.data() + f);
      hn::StoreU(hn::Mul(hn::Sub(back_re, z.re), half), d, y.im.data() + f);
    }
  }
}

/// All spectra of fields.map.
void transform_map(const CorrelateFields& fields, std::size_t width, std::size_t height, const Spectra& to) {
  const auto& map = fields.map;
  transform_fields(fields, map[0].data(), map[1].data(), width, height, to.packed);
  unpack(fields, to.packed, to.mask, to.energy);
  transform_fields(fields, map[2].data(), map[3].data(), width, height, to.slopes);
  unpack(fields, to.slopes, to.slope_u, to.slope_v);
}

/// First half of an inverse transform.
template <class Factors>
HWY_INLINE void transform_products(const CorrelateFields& fields, const ComplexField& half) {
  const Scratch scratch(fields);
  for (std::size_t v = 0; v < fields.size.height; v += kLines) {
    const Rows out{half.re.data() + v, half.im.data() + v, fields.spectrum_stride};
    transform_lines(fields.along_u->plan, Factors{{fields, v}}, out, scratch.swing);
  }
}

/// Second half of the k-th, for kLines shifts in u.
HWY_INLINE void transform_sums(const CorrelateFields& fields, std::size_t k, std::size_t u) {
  const Scratch scratch(fields);
  const std::size_t stride = fields.spectrum_stride;
  const std::size_t height = fields.size.height;
  transpose(fields.half[k].re.data() + u * stride, stride, height, scratch.swing[1], 2 * kLines);
  transpose(fields.half[k].im.data() + u * stride, stride, height, scratch.swing[1] + kLines, 2 * kLines);
  const Rows out{fields.sums[2 * k + 1].data() + u, fields.sums[2 * k].data() + u, fields.map_stride};
  transform_lines(fields.along_v->plan, Buffer{scratch.swing[1]}, out, scratch.swing);
}

/// Inverse hyperbolic tangent of 0 <= x < 1.
HWY_INLINE Vector atanh_of(Vector x) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> bits;
  const hn::RebindToSigned<Tag> whole;
  const auto one = hn::Set(d, 1.0F);
  const auto above = hn::Add(one, x);
  const auto below = hn::Sub(one, x);
  // (1 + x) / (1 - x) = power * m with m within a factor of sqrt 2 of 1.
  const auto ratio = hn::Mul(hn::Div(above, below), hn::Set(d, 1.4142135F));
  const auto power_bits = hn::And(hn::BitCast(bits, ratio), hn::Set(bits, 0x7F800000U));
  const auto power = hn::BitCast(d, power_bits);
  const auto exponent =
      hn::ConvertTo(d, hn::Sub(hn::BitCast(whole, hn::ShiftRight<23>(power_bits)), hn::Set(whole, 127)));
  const auto scaled = hn::Mul(power, below);
  const auto t = hn::Div(hn::Sub(above, scaled), hn::Add(above, scaled));
  const auto t2 = hn::Mul(t, t);
  auto series = hn::Set(d, 1.0F / 9.0F);
  for (const float term : {1.0F / 7.0F, 1.0F / 5.0F, 1.0F / 3.0F, 1.0F}) {
    series = hn::Add(hn::Mul(series, t2), hn::Set(d, term));
  }
  return hn::Add(hn::Mul(exponent, hn::Set(d, 0.34657359F)), hn::Mul(series, t));
}

/// Scores of kLines shifts in u, as Correlator says.
HWY_INLINE void score(const CorrelateFields& fields, std::size_t u, const ScoreRule& rule) {
  const Tag d;
  const auto zero = hn::Zero(d);
  const auto noise = hn::Set(d, 2.0F * rule.noise_slope * rule.noise_slope);
  const auto most = hn::Set(d, 0.98F);
  for (std::size_t v = 0; v < fields.size.height; ++v) {
    const std::size_t place = v * fields.map_stride + u;
    const auto sum = [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, fields.sums[k].data() + place); };
    float* to = fields.scores.data() + (v + 1) * fields.score_stride + u + 1;
    const auto n = sum(0);
    const auto enough = hn::Ge(n, hn::Set(d, rule.least_pixels));
    if (hn::AllFalse(d, enough)) {
      hn::StoreU(zero, d, to);
      continue;
    }
    const auto u1 = sum(2), v1 = sum(3), u2 = sum(4), minus_v2 = sum(5);
    const auto means = hn::Sub(hn::Mul(u1, u2), hn::Mul(v1, minus_v2));
    const auto squares = hn::Add(hn::Add(hn::Mul(u1, u1), hn::Mul(v1, v1)),
                                 hn::Add(hn::Mul(u2, u2), hn::Mul(minus_v2, minus_v2)));
    const auto covariance = hn::Sub(sum(6), hn::Div(means, n));
    const auto variance = hn::Max(zero, hn::Sub(sum(1), hn::Div(squares, n)));
    const auto explained = hn::Div(hn::Add(covariance, covariance), hn::Add(variance, hn::Mul(noise, n)));
    const auto clamped =
        hn::IfThenElseZero(hn::And(enough, hn::Gt(explained, zero)), hn::Min(explained, most));
    const auto outline = hn::Mul(sum(7), hn::Set(d, rule.outline));
    const auto both = hn::Add(hn::Mul(atanh_of(clamped), hn::Sqrt(n)), outline);
    hn::StoreU(hn::IfThenElseZero(enough, hn::Max(zero, both)), d, to);
  }
}

void correlate_spectra(CorrelateFields& fields, const ScoreRule& rule) {
  transform_products<PixelsAndEnergy>(fields, fields.half[0]);
  transform_products<FirstSlopes>(fields, fields.half[1]);
  transform_products<SecondSlopes>(fields, fields.half[2]);
  transform_products<TogetherAndAlong>(fields, fields.half[3]);
  for (std::size_t u = 0; u < fields.size.width; u += kLines) {
    for (std::size_t k = 0; k < fields.half.size(); ++k) transform_sums(fields, k, u);
    score(fields, u, rule);
  }
}

void find_maxima(const CorrelateFields& fields, std::vector<std::size_t>& places) {
  const Tag d;
  const std::size_t stride = fields.score_stride;
  for (std::size_t v = 0; v < fields.size.height; ++v) {
    const float* row = fields.scores.data() + (v + 1) * stride + 1;
    for (std::size_t u = 0; u < fields.size.width; u += kLines) {
      const auto here = hn::LoadU(d, row + u);
      const auto candidates = hn::And(hn::Gt(here, hn::Zero(d)), hn::FirstN(d, fields.size.width - u));
      if (hn::AllFalse(d, candidates)) continue;
      const auto above_next =
          hn::And(hn::Gt(here, hn::LoadU(d, row + u + 1)), hn::Gt(here, hn::LoadU(d, row + u + stride)));
      const auto above_last =
          hn::And(hn::Ge(here, hn::LoadU(d, row + u - 1)), hn::Ge(here, hn::LoadU(d, row + u - stride)));
      const auto peak = hn::And(candidates, hn::And(above_next, above_last));
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, peak, bits);
      for (std::size_t lane = 0; lane < kLines; ++lane) {
        if (((bits[lane / 8] >> (lane % 8)) & 1U) != 0) places.push_back(v * fields.size.width + u + lane);
      }
    }
  }
}

}  // namespace rejoin::match::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rejoin::match::detail {
namespace {

HWY_EXPORT(transform_map);
HWY_EXPORT(correlate_spectra);
HWY_EXPORT(find_maxima);

/// Rows and strides are whole vectors of the widest processor.
constexpr std::size_t kBlock = 16;

std::size_t padded(std::size_t count) {
  return (count + kBlock - 1) / kBlock * kBlock;
}

void transform(CorrelateFields& fields, const ReliefMap& map, float scale, const Spectra& to) {
  const auto width = static_cast<std::size_t>(map.width);
  const auto height = static_cast<std::size_t>(map.height);
  for (std::size_t j = 0; j < height; ++j) {
    float* rows[4];
    for (std::size_t k = 0; k < 4; ++k) rows[k] = fields.map[k].data() + j * fields.map_stride;
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t from = j * width + i;
      const float u = map.slope_u[from];
      const float v = map.slope_v[from];
      rows[0][i] = scale * map.mask[from];
      rows[1][i] = scale * (u * u + v * v);
      rows[2][i] = scale * u;
      rows[3][i] = scale * v;
    }
    for (float* row : rows) std::fill(row + width, row + padded(width), 0.0F);
  }
  HWY_DYNAMIC_DISPATCH(transform_map)(fields, width, height, to);
}

void set_filter(BorderFilter& filter, std::size_t length) {
  filter.slope.reserve(padded(length));
  filter.mean.reserve(padded(length));
  for (std::size_t f = 0; f < length; ++f) {
    double slope = 0.0;
    double mean = 0.0;
    for (std::size_t k = 0; k < kBorderSlope.size(); ++k) {
      const double angle = kTurn * static_cast<double>(f) * (static_cast<double>(k) - kBorderReach) /
                           static_cast<double>(length);
      slope += static_cast<double>(kBorderSlope[k]) * std::sin(angle);
      mean += static_cast<double>(kBorderMean[k]) * std::cos(angle);
    }
    filter.slope.data()[f] = static_cast<float>(slope * slope);
    filter.mean.data()[f] = static_cast<float>(mean * mean);
  }
}

/// Made once a length: a pair of fragments asks for hundreds of fields, of some tens of lengths.
const SideTables& tables_of(std::size_t length) {
  static std::mutex guard;
  static std::map<std::size_t, SideTables> known;
  const std::lock_guard lock(guard);
  const auto [place, is_new] = known.try_emplace(length);
  if (is_new) {
    place->second.plan = plan_fft(length);
    set_filter(place->second.border, length);
  }
  return place->second;
}

}  // namespace

void Field::reserve(std::size_t count) {
  if (count <= count_) return;
  numbers_ = hwy::AllocateAligned<float>(count + kSpare);
  std::fill_n(numbers_.get(), count + kSpare, 0.0F);
  count_ = count;
}

void ComplexField::reserve(std::size_t count) {
  re.reserve(count);
  im.reserve(count);
}

void resize(CorrelateFields& fields, FftSize size) {
  if (size == fields.size) return;
  fields.size = size;
  fields.along_u = &tables_of(size.width);
  fields.along_v = &tables_of(size.height);
  const std::size_t rows = padded(size.height);
  const std::size_t columns = padded(size.width);
  fields.map_stride = columns;
  fields.spectrum_stride = padded(size.height + 1);
  fields.score_stride = columns + kBlock;
  const std::size_t pixels = rows * fields.map_stride;
  const std::size_t frequencies = columns * fields.spectrum_stride;
  for (Field& field : fields.map) field.reserve(pixels);
  for (Field& field : fields.sums) field.reserve(pixels);
  for (ComplexField& field : fields.half) field.reserve(std::max(pixels, frequencies));
  for (Spectra* spectra : {&fields.first, &fields.second}) {
    for (ComplexField* field : {&spectra->packed, &spectra->mask, &spectra->energy, &spectra->slopes,
                                &spectra->slope_u, &spectra->slope_v}) {
      field->reserve(frequencies);
    }
  }
  fields.scores.reserve((size.height + 2) * fields.score_stride);
  for (Field& field : fields.scratch) field.reserve(std::max(rows, columns) * 2 * kBlock);
}

void set_first(CorrelateFields& fields, const ReliefMap& map) {
  // Inverse transforms are not divided by the number of shifts, so the first map is.
  const float shifts = static_cast<float>(fields.size.width) * static_cast<float>(fields.size.height);
  transform(fields, map, 1.0F / shifts, fields.first);
}

void correlate(CorrelateFields& fields, const ReliefMap& second, const ScoreRule& rule) {
  transform(fields, second, 1.0F, fields.second);
  HWY_DYNAMIC_DISPATCH(correlate_spectra)(fields, rule);
  const std::size_t stride = fields.score_stride;
  float* row = fields.scores.data() + stride;
  for (std::size_t v = 0; v < fields.size.height; ++v, row += stride) {
    row[0] = row[fields.size.width];
    row[fields.size.width + 1] = row[1];
  }
  float* frame = fields.scores.data();
  std::copy_n(frame + fields.size.height * stride, stride, frame);
  std::copy_n(frame + stride, stride, frame + (fields.size.height + 1) * stride);
}

void local_maxima(const CorrelateFields& fields, std::vector<std::size_t>& places) {
  places.clear();
  HWY_DYNAMIC_DISPATCH(find_maxima)(fields, places);
}

Sums sums_at(const CorrelateFields& fields, std::size_t place) {
  const std::size_t at = place / fields.size.width * fields.map_stride + place % fields.size.width;
  const auto sum = [&](std::size_t k) { return fields.sums[k].data()[at]; };
  return {sum(0), sum(1), sum(6), sum(7), sum(2), sum(3), sum(4), -sum(5)};
}

}  // namespace rejoin::match::detail
#endif
