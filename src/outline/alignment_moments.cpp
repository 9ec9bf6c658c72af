#include "outline/alignment_moments.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::outline {
namespace {

// Moments whose diagonals are closer than this many samples lay the borders along each other in the same way.
constexpr long kSameDiagonal = 5;
// A window reaches over one part in this many of the shorter border.
constexpr std::size_t kShare = 12;

/// values with `reach` samples of the other end before and after.
std::vector<float> continued(const std::vector<float>& values, std::size_t reach) {
  std::vector<float> out;
  out.reserve(values.size() + 2 * reach);
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count + 2 * reach; ++i)
    out.push_back(values[(i + count - reach % count) % count]);
  return out;
}

/// Sum of |turn| over the window around each sample.
std::vector<float> window_sums(const std::vector<float>& turn, std::size_t reach) {
  const std::vector<float> line = continued(turn, reach);
  std::vector<double> sums(line.size() + 1, 0.0);
  for (std::size_t i = 0; i < line.size(); ++i) sums[i + 1] = sums[i] + std::abs(line[i]);
  std::vector<float> out;
  out.reserve(turn.size());
  for (std::size_t i = 0; i < turn.size(); ++i)
    out.push_back(static_cast<float>(sums[i + 2 * reach + 1] - sums[i]));
  return out;
}

/// Adds weight * |a[k] - b[j + k]| over the window to cost[j], for all j.
void add_differences(const std::vector<float>& a, std::size_t at, const std::vector<float>& b,
                     std::size_t window, float weight, std::vector<float>& cost) {
  for (std::size_t k = 0; k < window; ++k) {
    const float value = a[at + k];
    const float* other = b.data() + k;
    for (std::size_t j = 0; j < cost.size(); ++j) cost[j] += weight * std::abs(value - other[j]);
  }
}

/// Keeps the best moment of each diagonal.
std::vector<Moment> distinct(std::vector<Moment> moments, long size_a, long size_b, std::size_t most) {
  std::sort(moments.begin(), moments.end(), [](const Moment& p, const Moment& q) {
    if (p.gain != q.gain) return p.gain > q.gain;
    return p.a != q.a ? p.a < q.a : p.b < q.b;
  });
  std::vector<Moment> kept;
  for (const Moment& moment : moments) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Moment& other) {
      long along_a = static_cast<long>(moment.a) - static_cast<long>(other.a);
      long along_b = static_cast<long>(moment.b) - static_cast<long>(other.b);
      along_a -= size_a * std::lround(static_cast<double>(along_a) / static_cast<double>(size_a));
      along_b -= size_b * std::lround(static_cast<double>(along_b) / static_cast<double>(size_b));
      return std::abs(along_a - along_b) < kSameDiagonal;
    });
    if (!known) kept.push_back(moment);
    if (kept.size() == most) break;
  }
  return kept;
}

}  // namespace

std::vector<Moment> alignment_moments(const PropertyPlot& a, const PropertyPlot& b,
                                      const MomentOptions& options) {
  const std::size_t shorter = std::min(a.size(), b.size());
  const std::size_t reach = std::max<std::size_t>(3, std::min(options.reach, shorter / kShare));
  const std::size_t window = 2 * reach + 1;
  const bool coloured = options.colour_share > 0.0 && a.channels.size() == 4 && b.channels.size() == 4;
  std::vector<std::vector<float>> lines_a;
  std::vector<std::vector<float>> lines_b;
  for (std::size_t c = 0; c < (coloured ? 4U : 1U); ++c) {
    lines_a.push_back(continued(a.channels[c], reach));
    lines_b.push_back(continued(b.channels[c], reach));
  }
  const std::vector<float> energy_a = window_sums(a.channels[0], reach);
  const std::vector<float> energy_b = window_sums(b.channels[0], reach);
  const double share = coloured ? options.colour_share : 0.0;
  const double weight = options.property_weight / (options.length_weight + options.property_weight);
  std::vector<Moment> moments;
  std::vector<float> cost(b.size());
  for (const std::size_t i : a.features) {
    std::fill(cost.begin(), cost.end(), 0.0F);
    for (std::size_t c = 0; c < lines_a.size(); ++c) {
      const double factor = c == 0 ? 1.0 - share : M_PI * share / 3.0;
      add_differences(lines_a[c], i, lines_b[c], window, static_cast<float>(weight * factor), cost);
    }
    for (std::size_t j = 0; j < cost.size(); ++j)
      cost[j] = 0.5F * (energy_a[i] + energy_b[j]) - cost[j];  // now the gain
    for (std::size_t j = 0; j < cost.size(); ++j) {
      const float before = cost[(j + cost.size() - 1) % cost.size()];
      const float after = cost[(j + 1) % cost.size()];
      if (cost[j] > 0.0F && cost[j] >= before && cost[j] > after) moments.push_back({i, j, cost[j]});
    }
  }
  return distinct(std::move(moments), static_cast<long>(a.size()), static_cast<long>(b.size()), options.most);
}

}  // namespace rejoin::outline
