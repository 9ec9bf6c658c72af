/// Smoothing of closed sequences.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/cyclic.hpp"

namespace rejoin {

/// Convolution of a closed sequence of evenly spaced values (numbers, points) with a Gaussian that ends at 3.5 standard
/// deviations.
/// \param deviation  its standard deviation in samples; 0 changes nothing, more than there are samples counts as their number, which
///                   leaves hardly more than their mean
template <typename Value>
std::vector<Value> smooth(const std::vector<Value>& values, double deviation) {
  if (deviation <= 0.0 || values.empty()) return values;
  deviation = std::min(deviation, static_cast<double>(values.size()));
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3.5 * deviation));
  std::vector<double> weights(static_cast<std::size_t>(reach) + 1);
  double sum = 0.0;
  for (std::ptrdiff_t k = 0; k <= reach; ++k) {
    const double x = static_cast<double>(k) / deviation;
    weights[static_cast<std::size_t>(k)] = std::exp(-0.5 * x * x);
    sum += weights[static_cast<std::size_t>(k)] * (k == 0 ? 1.0 : 2.0);
  }
  const auto count = static_cast<std::ptrdiff_t>(values.size());
  // Laid out with its ends repeated, so that the inner loop knows no wrap.
  std::vector<Value> around(values.size() + 2 * static_cast<std::size_t>(reach));
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(around.size()); ++i)
    around[static_cast<std::size_t>(i)] = values[wrapped(i - reach, values.size())];
  std::vector<Value> result(values.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Value* centre = around.data() + i + reach;
    Value total = weights[0] * centre[0];
    for (std::ptrdiff_t k = 1; k <= reach; ++k)
      total += weights[static_cast<std::size_t>(k)] * (centre[k] + centre[-k]);
    result[static_cast<std::size_t>(i)] = total / sum;
  }
  return result;
}

}  // namespace rejoin
