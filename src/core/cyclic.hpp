/// Places on closed sequences.
#pragma once

#include <concepts>
#include <cstddef>

namespace rejoin {

/// Index of the element at a place of a closed sequence, which goes on before its beginning and behind its end.
/// \param place  any, also below 0
/// \param count  elements of the sequence; > 0, and no more than `Place` can hold
template <std::signed_integral Place>
constexpr std::size_t wrapped(Place place, std::size_t count) {
  const auto around = static_cast<Place>(count);
  const auto rest = static_cast<Place>(place % around);
  return static_cast<std::size_t>(rest < 0 ? rest + around : rest);
}

}  // namespace rejoin
