/// Whether scans can be in the same unit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "match/match.hpp"

namespace rejoin::match {

/// Fragments of one object differ less in size; metres and millimetres differ by 1,000.
inline constexpr double kMostSizeRatio = 100.0;

/// \param diameter_a, diameter_b  of the scans, each in its own unit, above 0
inline bool units_differ(double diameter_a, double diameter_b) {
  return std::max(diameter_a, diameter_b) > kMostSizeRatio * std::min(diameter_a, diameter_b);
}

/// What another unit changes alike in a scan, in its own unit; 0: not known, or has none.
struct Lengths {
  double diameter = 0;
  double spacing = 0;  ///< of its points
  double noise = 0;
  double wall = 0;

  bool operator==(const Lengths&) const = default;
};

Lengths lengths_of(const Fragment& fragment);

/// Two groups of scans, by their numbers, ascending.
struct UnitGroups {
  std::vector<std::size_t> small;
  std::vector<std::size_t> large;
  double ratio = 1;  ///< how many times the lengths of the large are those of the small, above 1
};

/// Scans as in centimetres, inches or metres beside scans as in millimetres: two groups between whose walls, or whose spacings, a gap
/// lies, and of which the medians of all lengths differ alike, more than four times.  Small pieces of one box have the wall, the noise
/// or the spacing of large ones.  Inches beside centimetres (2.54 times) cannot be told from other sherds.
/// Split by their walls, a scan without one is in the group whose spacing is nearer.
/// \return nullopt if there are no such groups
std::optional<UnitGroups> units_apart(const std::vector<Lengths>& scans);

/// Units whose scans have such a ratio: "inches" and "millimetres".
struct Units {
  const char* of_small;
  const char* of_large;
};

/// \param ratio  as of UnitGroups
/// \return nullopt if no two of millimetre, centimetre, inch and metre are about so many times apart
std::optional<Units> likely_units(double ratio);

}  // namespace rejoin::match
