/// Pairs of fragments, whichever comes first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace rejoin::assembly {

inline std::pair<std::size_t, std::size_t> key_of(std::size_t a, std::size_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Whether two pieces are one of the pairs.
inline bool among(const std::vector<std::pair<std::size_t, std::size_t>>& pairs, std::size_t a,
                  std::size_t b) {
  return std::ranges::any_of(
      pairs, [&](const auto& pair) { return key_of(pair.first, pair.second) == key_of(a, b); });
}

}  // namespace rejoin::assembly
