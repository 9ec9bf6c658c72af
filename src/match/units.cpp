#include "match/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/median.hpp"

namespace rejoin::match {
namespace {

using Length = double Lengths::*;

// Between the groups, at least: the walls of one vessel differ by less.
constexpr double kGap = 2.5;
constexpr double kLeast = 4.0;
// Between a length's ratio and the common one: pieces of one object differ in size, scans of one scanner in their spacing and noise.
constexpr double kMostUnlike = 2.5;
// Between a ratio and that of two units.
constexpr double kMostOff = 1.5;

std::vector<double> known(const std::vector<Lengths>& scans, const std::vector<std::size_t>& group,
                          Length length) {
  std::vector<double> values;
  for (const std::size_t k : group) {
    if (scans[k].*length > 0) values.push_back(scans[k].*length);
  }
  return values;
}

std::optional<double> ratio_of(const std::vector<Lengths>& scans, const UnitGroups& groups, Length length) {
  std::vector<double> small = known(scans, groups.small, length);
  std::vector<double> large = known(scans, groups.large, length);
  if (small.empty() || large.empty()) return std::nullopt;
  return median(large) / median(small);
}

/// Solid pieces have no walls.
bool are_solid(const std::vector<Lengths>& scans, const UnitGroups& groups) {
  return known(scans, groups.small, &Lengths::wall).empty() &&
         known(scans, groups.large, &Lengths::wall).empty();
}

bool walls_have_a_gap(const std::vector<Lengths>& scans, const UnitGroups& groups) {
  return std::ranges::min(known(scans, groups.large, &Lengths::wall)) >
         kGap * std::ranges::max(known(scans, groups.small, &Lengths::wall));
}

/// Of the lengths, if all differ alike; it is that of those which the size of a piece has no influence on.
std::optional<double> common_ratio(const std::vector<Lengths>& scans, const UnitGroups& groups) {
  const bool solid = are_solid(scans, groups);
  std::vector<double> ratios;
  double logs = 0;
  for (const Length length : {&Lengths::diameter, &Lengths::spacing, &Lengths::noise, &Lengths::wall}) {
    if (length == &Lengths::wall && solid) continue;
    const std::optional<double> ratio = ratio_of(scans, groups, length);
    if (!ratio || *ratio <= kLeast) return std::nullopt;
    ratios.push_back(*ratio);
    if (length != &Lengths::diameter) logs += std::log(*ratio);
  }
  if (!solid && !walls_have_a_gap(scans, groups)) return std::nullopt;
  const double common = std::exp(logs / static_cast<double>(ratios.size() - 1));
  const auto [least, most] = std::ranges::minmax(ratios);
  if (most > kMostUnlike * common || common > kMostUnlike * least) return std::nullopt;
  return common;
}

/// Those of known length below every gap, and those above it.
std::vector<UnitGroups> split_at_gaps(const std::vector<Lengths>& scans, Length length) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (scans[k].*length > 0) order.push_back(k);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return scans[k].*length; });
  std::vector<UnitGroups> splits;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (scans[order[k]].*length <= kGap * (scans[order[k - 1]].*length)) continue;
    const auto gap = order.begin() + static_cast<std::ptrdiff_t>(k);
    splits.push_back({{order.begin(), gap}, {gap, order.end()}, 1});
    std::ranges::sort(splits.back().small);
    std::ranges::sort(splits.back().large);
  }
  return splits;
}

/// Puts scans that the split could not tell, solid pieces beside sherds, into the group whose spacing is nearer to theirs.
void add_rest(const std::vector<Lengths>& scans, UnitGroups& groups) {
  std::vector<double> small = known(scans, groups.small, &Lengths::spacing);
  std::vector<double> large = known(scans, groups.large, &Lengths::spacing);
  const double middle = std::sqrt(median(small) * median(large));
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (std::ranges::binary_search(groups.small, k) || std::ranges::binary_search(groups.large, k)) continue;
    std::vector<std::size_t>& group = scans[k].spacing < middle ? groups.small : groups.large;
    group.insert(std::ranges::lower_bound(group, k), k);
  }
}

}  // namespace

Lengths lengths_of(const Fragment& fragment) {
  return {fragment.diameter, fragment.resolution, fragment.noise, fragment.facets.wall_thickness};
}

std::optional<UnitGroups> units_apart(const std::vector<Lengths>& scans) {
  for (const Length length : {&Lengths::wall, &Lengths::spacing}) {
    for (UnitGroups& groups : split_at_gaps(scans, length)) {
      const std::optional<double> ratio = common_ratio(scans, groups);
      if (!ratio) continue;
      groups.ratio = *ratio;
      add_rest(scans, groups);
      return groups;
    }
  }
  return std::nullopt;
}

std::optional<Units> likely_units(double ratio) {
  struct Known {
    double ratio;
    Units units;
  };
  static constexpr std::array<Known, 5> kKnown{{{10.0, {"centimetres", "millimetres"}},
                                                {25.4, {"inches", "millimetres"}},
                                                {39.37, {"metres", "inches"}},
                                                {100.0, {"metres", "centimetres"}},
                                                {1000.0, {"metres", "millimetres"}}}};
  const auto off = [ratio](const Known& known) { return std::abs(std::log(ratio / known.ratio)); };
  const Known& nearest = *std::ranges::min_element(kKnown, {}, off);
  if (off(nearest) > std::log(kMostOff)) return std::nullopt;
  return nearest.units;
}

}  // namespace rejoin::match
