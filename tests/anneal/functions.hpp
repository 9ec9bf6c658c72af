/// Functions with known minima for the annealing tests.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "anneal/anneal.hpp"

namespace rejoin::anneal::testing {

inline constexpr double kPi = 3.14159265358979323846;

/// Turns a function of one point into a batch energy.
template <typename Function>
Energy batch(Function function) {
  return [function](std::span<const double> points, std::span<const int> chains, std::span<double> energies) {
    const std::size_t count = points.size() / chains.size();
    for (std::size_t k = 0; k < chains.size(); ++k) energies[k] = function(points.subspan(k * count, count));
  };
}

/// Minimum 0 at (0.3, 0.3, ...).
inline double quadratic(std::span<const double> x) {
  double sum = 0;
  for (const double v : x) sum += (v - 0.3) * (v - 0.3);
  return sum;
}

/// Rosenbrock's valley in two dimensions, minimum 0 at (1, 1).
inline double rosenbrock(std::span<const double> x) {
  const double bend = x[1] - x[0] * x[0];
  return 100 * bend * bend + (1 - x[0]) * (1 - x[0]);
}

/// Many equal hollows in a wide bowl on a circle of circumference 2 pi: minimum 0 where every angle is 6.2,
/// next to the seam of the wrap-around; the next hollows are 1/5 of a turn away.
inline double wrapped_rastrigin(std::span<const double> x) {
  double sum = 0;
  for (const double v : x) sum += 2 * (1 - std::cos(v - 6.2)) + 0.5 * (1 - std::cos(5 * (v - 6.2)));
  return sum;
}

inline std::vector<Variable> box(std::size_t count, double low, double high, bool wraps = false) {
  return std::vector<Variable>(count, Variable{low, high, wraps});
}

}  // namespace rejoin::anneal::testing
