/// Whether two scans can be in the same unit.
#pragma once

#include <algorithm>

namespace rejoin::match {

/// Fragments of one object differ less in size; metres and millimetres differ by 1,000.
inline constexpr double kMostSizeRatio = 100.0;

/// \param diameter_a, diameter_b  of the scans, each in its own unit, above 0
inline bool units_differ(double diameter_a, double diameter_b) {
  return std::max(diameter_a, diameter_b) > kMostSizeRatio * std::min(diameter_a, diameter_b);
}

}  // namespace rejoin::match
