#include "report/fragment_colours.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace rejoin::report {
namespace {

constexpr double kChroma = 0.09;
constexpr double kGoldenAngle = 2.399963229728653;

/// In OKLab, where distances are as they look.
glm::dvec3 lab_of(std::size_t k) {
  const double hue = 0.61 + kGoldenAngle * static_cast<double>(k);
  return {0.74 - 0.08 * static_cast<double>(k % 3), kChroma * std::cos(hue), kChroma * std::sin(hue)};
}

std::uint8_t channel(double linear) {
  const double cut = std::clamp(linear, 0.0, 1.0);
  const double value = cut <= 0.0031308 ? 12.92 * cut : 1.055 * std::pow(cut, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * value));
}

}  // namespace

Colour list_colour(std::size_t k) {
  const glm::dvec3 lab = lab_of(k);
  const double l = std::pow(lab.x + 0.3963377774 * lab.y + 0.2158037573 * lab.z, 3);
  const double m = std::pow(lab.x - 0.1055613458 * lab.y - 0.0638541728 * lab.z, 3);
  const double s = std::pow(lab.x - 0.0894841775 * lab.y - 1.291485548 * lab.z, 3);
  return {channel(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          channel(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          channel(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s)};
}

std::vector<Colour> fragment_colours(std::size_t count,
                                     const std::vector<std::pair<std::size_t, std::size_t>>& joins) {
  std::vector<std::vector<std::size_t>> neighbours(count);
  for (const auto& [a, b] : joins) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return neighbours[a].size() > neighbours[b].size(); });
  constexpr auto kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> chosen(count, kNone);
  std::vector<bool> taken(count, false);
  for (const std::size_t fragment : order) {
    double most = -1.0;
    for (std::size_t k = 0; k < count; ++k) {
      if (taken[k]) continue;
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t other : neighbours[fragment])
        if (chosen[other] != kNone) least = std::min(least, glm::distance(lab_of(k), lab_of(chosen[other])));
      if (least <= most) continue;
      most = least;
      chosen[fragment] = k;
    }
    taken[chosen[fragment]] = true;
  }
  std::vector<Colour> colours(count);
  for (std::size_t fragment = 0; fragment < count; ++fragment)
    colours[fragment] = list_colour(chosen[fragment]);
  return colours;
}

}  // namespace rejoin::report
