#include "match/correlate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "match/detail/correlate_kernel.hpp"

namespace rejoin::match {
namespace {

using detail::Sums;

float explained_by(const Sums& s, const CorrelateOptions& options) {
  const float n = s.n;
  const float cov = s.together - (s.u1 * s.u2 + s.v1 * s.v2) / n;
  const float variances =
      std::max(0.0F, s.energy - (s.u1 * s.u1 + s.v1 * s.v1 + s.u2 * s.u2 + s.v2 * s.v2) / n);
  return 2.0F * cov / (variances + 2.0F * n * options.noise_slope * options.noise_slope);
}

/// Fills pixels, explained, along and score.
/// \param border  the length of the shorter one
void judge(const Sums& s, float border, const CorrelateOptions& options, Agreement& a) {
  a.pixels = s.n;
  a.explained = explained_by(s, options);
  a.along = s.along / (detail::kBorderEnergy * border);
  a.score = std::atanh(std::clamp(a.explained, 0.0F, 0.98F)) * std::sqrt(s.n) +
            options.outline_weight * a.along * std::sqrt(border);
}

float shorter_border(const ReliefMap& a, const ReliefMap& b) {
  return static_cast<float>(std::max(1, std::min(a.border, b.border)));
}

/// By how many pixels a field may be shorter than both maps together.  Then shifts at opposite ends, where the maps overlap
/// by a and b lines, a + b the result, come to lie on one another; there are not `least` pixels in the two overlaps.
std::size_t lines_to_spare(const std::vector<int>& first, const std::vector<int>& second, float least) {
  const auto heads = [](auto begin, auto end) {  // of no lines, one, two and so on
    std::vector<int> sums{0};
    for (; begin != end; ++begin) sums.push_back(sums.back() + *begin);
    return sums;
  };
  const std::vector<int> head_1 = heads(first.begin(), first.end());
  const std::vector<int> tail_1 = heads(first.rbegin(), first.rend());
  const std::vector<int> head_2 = heads(second.begin(), second.end());
  const std::vector<int> tail_2 = heads(second.rbegin(), second.rend());
  const std::size_t most = std::min(first.size(), second.size());
  for (std::size_t spare = 1; spare <= most; ++spare) {
    for (std::size_t a = 0; a <= spare; ++a) {
      const std::size_t b = spare - a;
      const int overlap = std::min(tail_1[a], head_2[a]) + std::min(head_1[b], tail_2[b]);
      if (static_cast<float>(overlap) + 1.0F >= least) return spare - 1;
    }
  }
  return most;
}

}  // namespace

struct Correlator::Impl {
  ReliefMap fixed;
  CorrelateOptions options;
  detail::CorrelateFields fields;
  std::vector<std::size_t> places;

  /// Pixels that maps have to share.
  float least(const ReliefMap& other) const {
    return std::max(options.least_pixels,
                    options.least_overlap * static_cast<float>(std::min(fixed.pixels, other.pixels)));
  }

  detail::FftSize size_for(const ReliefMap& other) const {
    // Gradients reach beyond the ends of both maps, and must not meet around the field's end where the masks overlap enough.
    const auto side = [&](const std::vector<int>& lines, const std::vector<int>& other_lines) {
      return lines.size() + other_lines.size() + 2 * detail::kBorderReach -
             lines_to_spare(lines, other_lines, least(other));
    };
    return detail::fft_size(side(fixed.columns, other.columns), side(fixed.rows, other.rows));
  }

  Agreement at(std::size_t place, float border) const {
    Agreement a;
    judge(sums_at(fields, place), border, options, a);
    const int u = static_cast<int>(place % fields.size.width);
    const int v = static_cast<int>(place / fields.size.width);
    a.shift_u = u < fixed.width ? u : u - static_cast<int>(fields.size.width);
    a.shift_v = v < fixed.height ? v : v - static_cast<int>(fields.size.height);
    return a;
  }
};

Correlator::Correlator(const ReliefMap& fixed, const CorrelateOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->fixed = fixed;
  impl_->options = options;
}

Correlator::~Correlator() = default;
Correlator::Correlator(Correlator&&) noexcept = default;
Correlator& Correlator::operator=(Correlator&&) noexcept = default;

long Correlator::shifts() const {
  return static_cast<long>(impl_->fields.size.width * impl_->fields.size.height);
}

std::vector<std::size_t> Correlator::cheapest_order(std::span<const ReliefMap> others) const {
  std::vector<std::pair<std::size_t, std::size_t>> sizes;
  for (const ReliefMap& other : others) {
    const detail::FftSize size = impl_->size_for(other);
    sizes.emplace_back(size.width, size.height);
  }
  std::vector<std::size_t> order(others.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return sizes[k]; });
  return order;
}

std::vector<Agreement> Correlator::peaks(const ReliefMap& other) {
  Impl& d = *impl_;
  const detail::FftSize size = d.size_for(other);
  if (size != d.fields.size) {
    resize(d.fields, size);
    set_first(d.fields, d.fixed);
  }
  const float border = shorter_border(d.fixed, other);
  // Half a pixel for the rounding of the sums, which are whole numbers of pixels.
  correlate(d.fields, other,
            {std::ceil(d.least(other)) - 0.5F, d.options.noise_slope,
             d.options.outline_weight / (detail::kBorderEnergy * std::sqrt(border))});
  local_maxima(d.fields, d.places);
  std::vector<Agreement> found;
  for (const std::size_t place : d.places) found.push_back(d.at(place, border));
  const auto keep = std::min(found.size(), static_cast<std::size_t>(d.options.most_peaks));
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(keep), found.end(),
                    [](const Agreement& a, const Agreement& b) {
                      if (a.score != b.score) return a.score > b.score;
                      return a.shift_v != b.shift_v ? a.shift_v < b.shift_v : a.shift_u < b.shift_u;
                    });
  found.resize(keep);
  return found;
}

namespace {

constexpr int kReach = static_cast<int>(detail::kBorderReach);

/// The gradient of a map's mask at pixel (i, j), which may lie outside.
glm::vec2 gradient_of_mask(const ReliefMap& map, int i, int j) {
  glm::vec2 sum(0.0F);
  for (int v = std::max(0, j - kReach); v <= std::min(map.height - 1, j + kReach); ++v) {
    for (int u = std::max(0, i - kReach); u <= std::min(map.width - 1, i + kReach); ++u) {
      const auto k =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(u);
      const auto weight = [](const auto& weights, int from) {
        return weights[static_cast<std::size_t>(from)];
      };
      const int du = u - i + kReach;
      const int dv = v - j + kReach;
      sum += map.mask[k] * glm::vec2(weight(detail::kBorderSlope, du) * weight(detail::kBorderMean, dv),
                                     weight(detail::kBorderMean, du) * weight(detail::kBorderSlope, dv));
    }
  }
  return sum;
}

/// sum o1.o2, o the gradients of the masks.
float sum_along(const ReliefMap& fixed, const ReliefMap& other, int shift_u, int shift_v) {
  float sum = 0.0F;
  for (int j = std::max(0, shift_v) - kReach; j < std::min(fixed.height, other.height + shift_v) + kReach;
       ++j) {
    for (int i = std::max(0, shift_u) - kReach; i < std::min(fixed.width, other.width + shift_u) + kReach;
         ++i)
      sum += glm::dot(gradient_of_mask(fixed, i, j), gradient_of_mask(other, i - shift_u, j - shift_v));
  }
  return sum;
}

}  // namespace

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
      s.together += fixed.slope_u[p] * other.slope_u[q] + fixed.slope_v[p] * other.slope_v[q];
      s.energy += fixed.slope_u[p] * fixed.slope_u[p] + fixed.slope_v[p] * fixed.slope_v[p];
      s.energy += other.slope_u[q] * other.slope_u[q] + other.slope_v[q] * other.slope_v[q];
      s.u1 += fixed.slope_u[p];
      s.v1 += fixed.slope_v[p];
      s.u2 += other.slope_u[q];
      s.v2 += other.slope_v[q];
    }
  }
  if (s.n > 0.0F) s.along = sum_along(fixed, other, shift_u, shift_v);
  Agreement a;
  a.shift_u = shift_u;
  a.shift_v = shift_v;
  if (s.n > 0.0F) judge(s, shorter_border(fixed, other), options, a);
  return a;
}

}  // namespace rejoin::match
