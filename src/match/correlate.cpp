#include "match/correlate.hpp"

#include <kiss_fft.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace rejoin::match {
namespace {

using Complex = std::complex<float>;
using Field = std::vector<Complex>;
static_assert(sizeof(Complex) == sizeof(kiss_fft_cpx));

struct Sums {
  float n, c, e1, e2, s1u, s1v, s2u, s2v;
};

float explained_by(const Sums& s, const CorrelateOptions& options) {
  const float n = s.n;
  const float cov = s.c - (s.s1u * s.s2u + s.s1v * s.s2v) / n;
  const float var1 = std::max(0.0F, s.e1 - (s.s1u * s.s1u + s.s1v * s.s1v) / n);
  const float var2 = std::max(0.0F, s.e2 - (s.s2u * s.s2u + s.s2v * s.s2v) / n);
  return 2.0F * cov / (var1 + var2 + 2.0F * n * options.noise_slope * options.noise_slope);
}

float score_of(float explained, float pixels) {
  return std::atanh(std::clamp(explained, -0.98F, 0.98F)) * std::sqrt(pixels);
}

/// Fills pixels, explained, score and tilt.
void judge(const Sums& s, const CorrelateOptions& options, Agreement& a) {
  a.pixels = s.n;
  a.explained = explained_by(s, options);
  a.score = score_of(a.explained, s.n);
  a.tilt = glm::vec2(s.s1u - s.s2u, s.s1v - s.s2v) / s.n;
}

/// a * conj(b), without std::complex's care for infinities, which is slow.
Complex times_conjugate(Complex a, Complex b) {
  return {a.real() * b.real() + a.imag() * b.imag(), a.imag() * b.real() - a.real() * b.imag()};
}

/// x + i y
Complex packed_of(Complex x, Complex y) {
  return {x.real() - y.imag(), x.imag() + y.real()};
}

/// Complex transforms of one size, first along the columns, then along the rows, so that columns that are empty before and
/// rows that nobody asks for after cost nothing.
class Transform {
 public:
  Transform() = default;
  Transform(int width, int height, bool inverse)
      : width_(width),
        height_(height),
        along_columns_(kiss_fft_alloc(height, inverse ? 1 : 0, nullptr, nullptr)),
        along_rows_(kiss_fft_alloc(width, inverse ? 1 : 0, nullptr, nullptr)) {}

  /// \param columns  the others of `in` are zero
  /// \param half     width x height, column by column, for row()
  void columns(const Field& in, int columns, Field& half) const {
    for (int i = 0; i < columns; ++i) {
      kiss_fft_stride(along_columns_.get(), data(in) + i, data(half) + at(i, height_), width_);
    }
    std::fill(half.begin() + static_cast<std::ptrdiff_t>(at(columns, height_)), half.end(), Complex(0));
  }

  void row(const Field& half, int row, Field& out) const {
    kiss_fft_stride(along_rows_.get(), data(half) + row, data(out) + at(row, width_), height_);
  }

 private:
  struct Free {
    void operator()(kiss_fft_cfg plan) const { kiss_fft_free(plan); }
  };
  using Plan = std::unique_ptr<kiss_fft_state, Free>;

  static std::size_t at(int line, int length) {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(length);
  }
  static const kiss_fft_cpx* data(const Field& field) {
    return reinterpret_cast<const kiss_fft_cpx*>(field.data());
  }
  static kiss_fft_cpx* data(Field& field) { return reinterpret_cast<kiss_fft_cpx*>(field.data()); }

  int width_ = 0;
  int height_ = 0;
  Plan along_columns_;
  Plan along_rows_;
};

struct Spectra {
  Field k, u, v, q;
};

}  // namespace

struct Correlator::Impl {
  CorrelateOptions options;
  int width = 0;  ///< of the padded fields
  int height = 0;
  int fixed_width = 0;
  int fixed_height = 0;
  float fixed_pixels = 0;
  Transform forward;
  Transform backward;
  Spectra first;
  Spectra second;
  Field packed;
  Field spectrum;
  Field half;                 ///< transformed along the columns only
  std::array<Field, 4> sums;  ///< n + i c, e1 + i e2, s1u + i s1v, s2u + i s2v
  std::vector<char>
      rows;  ///< of the sums: whether any shift has overlap enough; no other row is valid but in sums[0]
  std::vector<float> scores;

  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

  /// Spectra of two real maps by one complex transform:
  /// X = (Z(f) + conj Z(-f)) / 2, Y = (Z(f) - conj Z(-f)) / 2i.
  template <class Fill>
  void transform_two(const ReliefMap& map, Fill fill, Field& x, Field& y) {
    std::fill(packed.begin(), packed.end(), Complex(0));
    for (int j = 0; j < map.height; ++j) {
      for (int i = 0; i < map.width; ++i) {
        const auto from =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(i);
        packed[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)] =
            fill(from);
      }
    }
    forward.columns(packed, map.width, half);
    for (int j = 0; j < height; ++j) forward.row(half, j, spectrum);
    x.resize(size());
    y.resize(size());
    for (int j = 0; j < height; ++j) {
      const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(width);
      const std::size_t back_row =
          static_cast<std::size_t>(j == 0 ? 0 : height - j) * static_cast<std::size_t>(width);
      for (int i = 0; i < width; ++i) {
        // Part by part: whole complex numbers go through memory here, at thrice the time.
        const Complex& z = spectrum[row + static_cast<std::size_t>(i)];
        const Complex& w = spectrum[back_row + static_cast<std::size_t>(i == 0 ? 0 : width - i)];
        const float zr = z.real();
        const float zi = z.imag();
        const float wr = w.real();
        const float wi = w.imag();
        x[row + static_cast<std::size_t>(i)] = {0.5F * (zr + wr), 0.5F * (zi - wi)};
        y[row + static_cast<std::size_t>(i)] = {0.5F * (zi + wi), -0.5F * (zr - wr)};
      }
    }
  }

  void transform_map(const ReliefMap& map, Spectra& out) {
    transform_two(
        map,
        [&](std::size_t p) {
          return Complex(map.mask[p], map.slope_u[p] * map.slope_u[p] + map.slope_v[p] * map.slope_v[p]);
        },
        out.k, out.q);
    transform_two(
        map, [&](std::size_t p) { return Complex(map.slope_u[p], map.slope_v[p]); }, out.u, out.v);
  }

  /// One complex inverse transform for two real fields.
  /// \param product  packed spectra at a frequency
  template <class Product>
  void transform_back(Product product, Field& sum) {
    for (std::size_t f = 0; f < packed.size(); ++f) packed[f] = product(f);
    backward.columns(packed, width, half);
    for (int j = 0; j < height; ++j) {
      if (rows[static_cast<std::size_t>(j)] != 0) backward.row(half, j, sum);
    }
  }

  /// All eight sums at all shifts with overlap enough.
  void correlate(float enough) {
    const Spectra& a = first;
    const Spectra& b = second;
    std::fill(rows.begin(), rows.end(), 1);
    transform_back(
        [&](std::size_t f) {
          return packed_of(times_conjugate(a.k[f], b.k[f]),
                           times_conjugate(a.u[f], b.u[f]) + times_conjugate(a.v[f], b.v[f]));
        },
        sums[0]);
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const auto row = sums[0].begin() + static_cast<std::ptrdiff_t>(j * static_cast<std::size_t>(width));
      rows[j] = std::any_of(row, row + width, [&](Complex sum) { return !(sum.real() < enough); }) ? 1 : 0;
    }
    transform_back(
        [&](std::size_t f) {
          return packed_of(times_conjugate(a.q[f], b.k[f]), times_conjugate(a.k[f], b.q[f]));
        },
        sums[1]);
    transform_back(
        [&](std::size_t f) {
          return packed_of(times_conjugate(a.u[f], b.k[f]), times_conjugate(a.v[f], b.k[f]));
        },
        sums[2]);
    transform_back(
        [&](std::size_t f) {
          return packed_of(times_conjugate(a.k[f], b.u[f]), times_conjugate(a.k[f], b.v[f]));
        },
        sums[3]);
  }

  Sums sums_at(std::size_t place) const {
    const float scale = 1.0F / static_cast<float>(size());
    return {sums[0][place].real() * scale, sums[0][place].imag() * scale, sums[1][place].real() * scale,
            sums[1][place].imag() * scale, sums[2][place].real() * scale, sums[2][place].imag() * scale,
            sums[3][place].real() * scale, sums[3][place].imag() * scale};
  }

  /// 0 where nothing is explained or the overlap is too small.
  float score_at(std::size_t place, float enough) const {
    if (sums[0][place].real() < enough) return 0.0F;
    const Sums s = sums_at(place);
    const float explained = explained_by(s, options);
    return explained > 0.0F ? score_of(explained, s.n) : 0.0F;
  }

  Agreement at(std::size_t place) const {
    Agreement a;
    judge(sums_at(place), options, a);
    const int u = static_cast<int>(place % static_cast<std::size_t>(width));
    const int v = static_cast<int>(place / static_cast<std::size_t>(width));
    a.shift_u = u < fixed_width ? u : u - width;
    a.shift_v = v < fixed_height ? v : v - height;
    return a;
  }
};

namespace {

int good_size(int least) {
  return kiss_fft_next_fast_size(least);
}

}  // namespace

Correlator::Correlator(const ReliefMap& fixed, int most_width, int most_height,
                       const CorrelateOptions& options)
    : impl_(std::make_unique<Impl>()) {
  Impl& d = *impl_;
  d.options = options;
  d.width = good_size(fixed.width + most_width);
  d.height = good_size(fixed.height + most_height);
  d.fixed_width = fixed.width;
  d.fixed_height = fixed.height;
  d.fixed_pixels = static_cast<float>(fixed.pixels);
  d.forward = Transform(d.width, d.height, false);
  d.backward = Transform(d.width, d.height, true);
  d.packed.resize(d.size());
  d.spectrum.resize(d.size());
  d.half.resize(d.size());
  for (Field& sum : d.sums) sum.resize(d.size());
  d.rows.resize(static_cast<std::size_t>(d.height));
  d.scores.resize(d.size());
  d.transform_map(fixed, d.first);
}

Correlator::~Correlator() = default;
Correlator::Correlator(Correlator&&) noexcept = default;
Correlator& Correlator::operator=(Correlator&&) noexcept = default;

long Correlator::shifts() const {
  return static_cast<long>(impl_->size());
}

std::vector<Agreement> Correlator::peaks(const ReliefMap& other) {
  Impl& d = *impl_;
  d.transform_map(other, d.second);
  const float least =
      std::max(d.options.least_pixels,
               d.options.least_overlap * std::min(d.fixed_pixels, static_cast<float>(other.pixels)));
  const float enough = least * static_cast<float>(d.size());
  d.correlate(enough);
  for (std::size_t p = 0; p < d.size(); ++p) d.scores[p] = d.score_at(p, enough);
  std::vector<Agreement> found;
  const auto w = static_cast<std::size_t>(d.width);
  const auto h = static_cast<std::size_t>(d.height);
  for (std::size_t j = 0; j < h; ++j) {
    const std::size_t up = (j + 1) % h * w;
    const std::size_t down = (j + h - 1) % h * w;
    for (std::size_t i = 0; i < w; ++i) {
      const float s = d.scores[j * w + i];
      if (!(s > 0.0F)) continue;
      const std::size_t right = (i + 1) % w;
      const std::size_t left = (i + w - 1) % w;
      if (s <= d.scores[j * w + right] || s < d.scores[j * w + left] || s <= d.scores[up + i] ||
          s < d.scores[down + i])
        continue;
      found.push_back(d.at(j * w + i));
    }
  }
  const auto keep = std::min(found.size(), static_cast<std::size_t>(d.options.most_peaks));
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(keep), found.end(),
                    [](const Agreement& a, const Agreement& b) {
                      if (a.score != b.score) return a.score > b.score;
                      return a.shift_v != b.shift_v ? a.shift_v < b.shift_v : a.shift_u < b.shift_u;
                    });
  found.resize(keep);
  return found;
}

Agreement agreement_at(const ReliefMap& fixed, const ReliefMap& other, int shift_u, int shift_v,
                       const CorrelateOptions& options) {
  Sums s{};
  for (int j = std::max(0, shift_v); j < std::min(fixed.height, other.height + shift_v); ++j) {
    for (int i = std::max(0, shift_u); i < std::min(fixed.width, other.width + shift_u); ++i) {
      const auto p =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(fixed.width) + static_cast<std::size_t>(i);
      const auto q = static_cast<std::size_t>(j - shift_v) * static_cast<std::size_t>(other.width) +
                     static_cast<std::size_t>(i - shift_u);
      const float both = fixed.mask[p] * other.mask[q];
      if (both == 0.0F) continue;
      s.n += 1.0F;
      s.c += fixed.slope_u[p] * other.slope_u[q] + fixed.slope_v[p] * other.slope_v[q];
      s.e1 += fixed.slope_u[p] * fixed.slope_u[p] + fixed.slope_v[p] * fixed.slope_v[p];
      s.e2 += other.slope_u[q] * other.slope_u[q] + other.slope_v[q] * other.slope_v[q];
      s.s1u += fixed.slope_u[p];
      s.s1v += fixed.slope_v[p];
      s.s2u += other.slope_u[q];
      s.s2v += other.slope_v[q];
    }
  }
  Agreement a;
  a.shift_u = shift_u;
  a.shift_v = shift_v;
  if (s.n > 0.0F) judge(s, options, a);
  return a;
}

}  // namespace rejoin::match
