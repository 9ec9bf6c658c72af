#include "outline/detail/independence.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rejoin::outline::detail {
namespace {

/// Lags up to this share of a series are looked at; beyond, few pairs tell its autocorrelation.
constexpr std::size_t kLagShare = 2;

std::vector<double> centred(std::span<const double> series) {
  double mean = 0.0;
  for (const double value : series) mean += value;
  mean /= static_cast<double>(series.size());
  std::vector<double> result;
  result.reserve(series.size());
  for (const double value : series) result.push_back(value - mean);
  return result;
}

double product_at(const std::vector<double>& series, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < series.size(); ++i) sum += series[i] * series[i - lag];
  return sum;
}

}  // namespace

double independent_samples(std::span<const double> a, std::span<const double> b) {
  const std::vector<double> from_a = centred(a);
  const std::vector<double> from_b = centred(b);
  const double variances = product_at(from_a, 0) * product_at(from_b, 0);
  if (!(variances > 0.0)) return 0.0;
  double sum = 0.0;
  const auto count = static_cast<double>(a.size());
  for (std::size_t lag = 1; lag <= a.size() / kLagShare; ++lag) {
    const double left = 1.0 - static_cast<double>(lag) / count;
    const double product = product_at(from_a, lag) * product_at(from_b, lag) / variances;
    sum += left * (product - left / count);
  }
  return count / std::max(1.0, 1.0 + 2.0 * sum);
}

}  // namespace rejoin::outline::detail
