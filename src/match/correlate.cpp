#include "match/correlate.hpp"

#include <kiss_fft.h>
#include <kiss_fftnd.h>

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

/// Fills pixels, explained, score and tilt.
void judge(const Sums& s, const CorrelateOptions& options, Agreement& a) {
  const float n = s.n;
  const float cov = s.c - (s.s1u * s.s2u + s.s1v * s.s2v) / n;
  const float var1 = std::max(0.0F, s.e1 - (s.s1u * s.s1u + s.s1v * s.s1v) / n);
  const float var2 = std::max(0.0F, s.e2 - (s.s2u * s.s2u + s.s2v * s.s2v) / n);
  a.pixels = n;
  a.explained = 2.0F * cov / (var1 + var2 + 2.0F * n * options.noise_slope * options.noise_slope);
  a.score = std::atanh(std::clamp(a.explained, -0.98F, 0.98F)) * std::sqrt(n);
  a.tilt = glm::vec2(s.s1u - s.s2u, s.s1v - s.s2v) / n;
}

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
  kiss_fftnd_cfg forward = nullptr;
  kiss_fftnd_cfg backward = nullptr;
  Spectra first;
  Spectra second;
  Field packed;
  Field spectrum;
  std::array<Field, 4> sums;
  std::vector<float> scores;

  ~Impl() {
    kiss_fft_free(forward);
    kiss_fft_free(backward);
  }

  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

  void transform(kiss_fftnd_cfg plan, const Field& in, Field& out) const {
    kiss_fftnd(plan, reinterpret_cast<const kiss_fft_cpx*>(in.data()),
               reinterpret_cast<kiss_fft_cpx*>(out.data()));
  }

  /// Spectra of two real maps by one complex transform: X = (Z(f) + conj Z(-f)) / 2, Y = (Z(f) - conj Z(-f))
  /// / 2i.
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
    transform(forward, packed, spectrum);
    x.resize(size());
    y.resize(size());
    for (int j = 0; j < height; ++j) {
      const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(width);
      const std::size_t back_row =
          static_cast<std::size_t>(j == 0 ? 0 : height - j) * static_cast<std::size_t>(width);
      for (int i = 0; i < width; ++i) {
        const Complex z = spectrum[row + static_cast<std::size_t>(i)];
        const Complex w = std::conj(spectrum[back_row + static_cast<std::size_t>(i == 0 ? 0 : width - i)]);
        x[row + static_cast<std::size_t>(i)] = 0.5F * (z + w);
        const Complex d = 0.5F * (z - w);
        y[row + static_cast<std::size_t>(i)] = Complex(d.imag(), -d.real());
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

  /// All eight sums at all shifts, two real fields a complex inverse transform.
  void correlate() {
    const std::size_t count = size();
    const Complex i(0, 1);
    for (auto& field : sums) field.resize(count);
    for (int which = 0; which < 4; ++which) {
      for (std::size_t f = 0; f < count; ++f) {
        const Complex k2 = std::conj(second.k[f]);
        Complex real;
        Complex imaginary;
        switch (which) {
          case 0:
            real = first.k[f] * k2;
            imaginary = first.u[f] * std::conj(second.u[f]) + first.v[f] * std::conj(second.v[f]);
            break;
          case 1:
            real = first.q[f] * k2;
            imaginary = first.k[f] * std::conj(second.q[f]);
            break;
          case 2:
            real = first.u[f] * k2;
            imaginary = first.v[f] * k2;
            break;
          default:
            real = first.k[f] * std::conj(second.u[f]);
            imaginary = first.k[f] * std::conj(second.v[f]);
        }
        packed[f] = Complex(real.real() - imaginary.imag(), real.imag() + imaginary.real());
      }
      transform(backward, packed, sums[static_cast<std::size_t>(which)]);
    }
  }

  Agreement at(std::size_t place) const {
    const float scale = 1.0F / static_cast<float>(size());
    Sums s{};
    s.n = sums[0][place].real() * scale;
    s.c = sums[0][place].imag() * scale;
    s.e1 = sums[1][place].real() * scale;
    s.e2 = sums[1][place].imag() * scale;
    s.s1u = sums[2][place].real() * scale;
    s.s1v = sums[2][place].imag() * scale;
    s.s2u = sums[3][place].real() * scale;
    s.s2v = sums[3][place].imag() * scale;
    Agreement a;
    judge(s, options, a);
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
  const std::array<int, 2> dims{d.height, d.width};
  d.forward = kiss_fftnd_alloc(dims.data(), 2, 0, nullptr, nullptr);
  d.backward = kiss_fftnd_alloc(dims.data(), 2, 1, nullptr, nullptr);
  d.packed.resize(d.size());
  d.spectrum.resize(d.size());
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
  d.correlate();
  const float least =
      std::max(d.options.least_pixels,
               d.options.least_overlap * std::min(d.fixed_pixels, static_cast<float>(other.pixels)));
  const float enough = least * static_cast<float>(d.size());
  for (std::size_t p = 0; p < d.size(); ++p) {
    d.scores[p] = d.sums[0][p].real() < enough ? 0.0F : d.at(p).score;
  }
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
