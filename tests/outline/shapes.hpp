/// Outlines that tests make: wavy closed curves, and pairs that were one.
#pragma once

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "outline/outline.hpp"

namespace rejoin::outline::testing {

/// Circle of even points, counter-clockwise.
inline std::vector<glm::dvec2> circle(double radius, std::size_t count) {
  std::vector<glm::dvec2> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// A rough line from (0, 0) to (length, 0): sums of sines with random phases, a point each unit.
inline std::vector<glm::dvec2> rough_line(double length, double height, std::uint64_t seed) {
  Random random(seed);
  std::vector<glm::dvec4> waves;  // wave number, phase, amplitude
  for (int k = 1; k <= 24; ++k)
    waves.emplace_back(k * M_PI / length * 1.7, random.uniform(0.0, 2.0 * M_PI),
                       height * random.normal() / std::pow(k, 0.9), 0.0);
  std::vector<glm::dvec2> points;
  const auto count = static_cast<std::size_t>(length);
  points.reserve(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    const auto x = static_cast<double>(i);
    double y = 0.0;
    for (const glm::dvec4& w : waves) y += w.z * std::sin(w.x * x + w.y);
    points.emplace_back(x, y * std::sin(M_PI * x / length));
  }
  return points;
}

/// Straight run of points, a unit apart, without the last one.
inline void add_run(std::vector<glm::dvec2>& polygon, glm::dvec2 from, glm::dvec2 to) {
  const auto count = static_cast<std::size_t>(std::lround(glm::distance(from, to)));
  for (std::size_t i = 0; i < count; ++i)
    polygon.push_back(glm::mix(from, to, static_cast<double>(i) / static_cast<double>(count)));
}

/// A tile of `length` by 2 * `height` broken along a rough line: the part below it (its upper border runs along the line
/// backwards) and the part above it, moved by `motion`.
struct BrokenTile {
  Outline lower;
  Outline upper;
  Planar upper_to_lower;  ///< takes the moved upper part back to its place
};

inline BrokenTile broken_tile(double length, double height, const Planar& motion, std::uint64_t seed) {
  const std::vector<glm::dvec2> line = rough_line(length, 0.1 * height, seed);
  BrokenTile tile;
  add_run(tile.lower.points, {0, -height}, {length, -height});
  add_run(tile.lower.points, {length, -height}, line.back());
  tile.lower.points.insert(tile.lower.points.end(), line.rbegin(), line.rend() - 1);
  add_run(tile.lower.points, line.front(), {0, -height});
  tile.upper.points.assign(line.begin(), line.end() - 1);
  add_run(tile.upper.points, line.back(), {length, height});
  add_run(tile.upper.points, {length, height}, {0, height});
  add_run(tile.upper.points, {0, height}, line.front());
  for (glm::dvec2& p : tile.upper.points) p = motion(p);
  tile.upper_to_lower = inverse(motion);
  return tile;
}

}  // namespace rejoin::outline::testing
