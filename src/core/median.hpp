/// The middle and other quantiles of a set of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rejoin {

/// The median, the upper one of an even count, 0 of none; brings the values into another order.
template <typename Value>
Value median(std::vector<Value>& values) {
  if (values.empty()) return Value{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value that a share (0 to 1) of them is no larger than, 0 of none; brings the values into another order.
template <typename Value>
Value quantile(std::vector<Value>& values, double share) {
  if (values.empty()) return Value{};
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace rejoin
