/// Longest common subsequences of numbers that need not be quite equal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace rejoin::outline {

/// Matched positions (in a, in b), both ascending.
using Pairing = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Length of the longest common subsequence where x matches y if |x - y| <= tolerance.  Exact; 64 cells a step: the
/// recurrence V = (V + (V & M)) | (V & ~M) of Hyyro 2004 on the positions M of b that match.
std::size_t lcs_length(std::span<const float> a, std::span<const float> b, float tolerance);

/// One such subsequence; of several the one whose matches come last.  Memory a.size() * b.size() / 8 bytes.
Pairing lcs(std::span<const float> a, std::span<const float> b, float tolerance);

/// How b is looked at.  \source naiman 2018, section 6.2
enum class Order {
  Same,
  Reversed,
  Negated,          ///< B lies upside down, if both borders run the same way round
  ReversedNegated,  ///< B lies as it is, if both borders run the same way round
};
inline constexpr std::array<Order, 4> kOrders{Order::Same, Order::Reversed, Order::Negated,
                                              Order::ReversedNegated};

/// b in this order.
std::vector<float> in_order(std::span<const float> b, Order order);

/// A common subsequence of two closed sequences.
struct CyclicMatch {
  Order order = Order::Same;
  Pairing pairs;  ///< positions in a and in b as given, in the order in which they lie along a; cyclic
  std::size_t centre = 0;  ///< the pair in the middle of where the matches cluster
};

/// The best of the four half rotations (neither, a, b, both), then centred: both sequences are turned so that the densest
/// cluster of matches lies in their middles, and matched again.
/// \source naiman 2018, section 6.3; deviation: the centring, which the paper leaves to another one, takes the tightest
/// stretch that holds a quarter of the matches
CyclicMatch cyclic_lcs(std::span<const float> a, std::span<const float> b, float tolerance, Order order);

/// The best of all 16 variants: four orders with four half rotations each.
CyclicMatch cyclic_lcs(std::span<const float> a, std::span<const float> b, float tolerance);

}  // namespace rejoin::outline
