/// Stretches of two sequences that fit one to one.
#pragma once

#include <cstdint>
#include <vector>

#include "outline/detail/pairing.hpp"

namespace rejoin::outline::detail {

/// `length` samples of A from i on and of B from j on, with their gain: the sum of xi^2 times both reliefs, less the squared difference.
struct Stretch {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::int32_t length = 0;
  double gain = 0.0;
};

/// Which stretches count.
struct StretchRule {
  double xi2 = 0.0;         ///< what a pair of samples may differ by, squared
  double least_gain = 0.0;  ///< stretches that gain no more are left out
  std::int32_t least = 0;   ///< shorter ones, too
};

/// Looks along all diagonals of two closed sequences.  A stretch ends where its gain has fallen to 0, or by as much as six perfect pairs of
/// samples give; it is cut where it gained most.  Stretches may run over A's end once and over B's as often as A's length asks, but none
/// begins twice.  Several diagonals at a time (SIMD); the order of the result depends on how many, its content does not.
std::vector<Stretch> find_stretches(const Sequences& sequences, const StretchRule& rule);

}  // namespace rejoin::outline::detail
