#include "match/units.hpp"

#include "core/median.hpp"

namespace rejoin::match {
namespace {

using Length = double Lengths::*;

// Between the groups, at least: the walls of one vessel differ by less.
constexpr double kGap = 2.5;
constexpr double kLeast = 4.0;
constexpr double kMost = 25.0;

std::vector<double> known(const std::vector<Lengths>& scans, const std::vector<std::size_t>& group,
                          Length length) {
  std::vector<double> values;
  for (const std::size_t k : group) {
    if (scans[k].*length > 0) values.push_back(scans[k].*length);
  }
  return values;
}

bool differ_ten_times(const std::vector<Lengths>& scans, const TenTimes& groups, Length length) {
  std::vector<double> small = known(scans, groups.small, length);
  std::vector<double> large = known(scans, groups.large, length);
  if (small.empty() || large.empty()) return false;
  const double ratio = median(large) / median(small);
  return ratio > kLeast && ratio < kMost;
}

/// Solid pieces have no walls.
bool walls_differ(const std::vector<Lengths>& scans, const TenTimes& groups) {
  const std::vector<double> small = known(scans, groups.small, &Lengths::wall);
  const std::vector<double> large = known(scans, groups.large, &Lengths::wall);
  if (small.empty() && large.empty()) return true;
  return differ_ten_times(scans, groups, &Lengths::wall) &&
         *std::ranges::min_element(large) > kGap * *std::ranges::max_element(small);
}

bool are_ten_times_apart(const std::vector<Lengths>& scans, const TenTimes& groups) {
  for (const Length length : {&Lengths::diameter, &Lengths::spacing, &Lengths::noise}) {
    if (!differ_ten_times(scans, groups, length)) return false;
  }
  return walls_differ(scans, groups);
}

/// Those of known length below every gap, and those above it.
std::vector<TenTimes> split_at_gaps(const std::vector<Lengths>& scans, Length length) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (scans[k].*length > 0) order.push_back(k);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return scans[k].*length; });
  std::vector<TenTimes> splits;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (scans[order[k]].*length <= kGap * (scans[order[k - 1]].*length)) continue;
    const auto gap = order.begin() + static_cast<std::ptrdiff_t>(k);
    splits.push_back({{order.begin(), gap}, {gap, order.end()}});
    std::ranges::sort(splits.back().small);
    std::ranges::sort(splits.back().large);
  }
  return splits;
}

}  // namespace

Lengths lengths_of(const Fragment& fragment) {
  return {fragment.diameter, fragment.resolution, fragment.noise, fragment.facets.wall_thickness};
}

std::optional<TenTimes> ten_times_apart(const std::vector<Lengths>& scans) {
  for (const Length length : {&Lengths::wall, &Lengths::spacing}) {
    for (const TenTimes& groups : split_at_gaps(scans, length)) {
      if (are_ten_times_apart(scans, groups)) return groups;
    }
  }
  return std::nullopt;
}

}  // namespace rejoin::match
