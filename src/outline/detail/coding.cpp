#include "outline/detail/coding.hpp"

#include <algorithm>
#include <cmath>

#include "core/median.hpp"
#include "core/smooth.hpp"

namespace rejoin::outline::detail {
namespace {

/// Corners turn far more than anything else; beyond this they would outweigh the rest of a boundary.
constexpr double kTurningLimit = 4.0;
/// Relief is judged over this many samples (standard deviation).
constexpr double kReliefReach = 3.0;
/// A normal distribution's deviation from the median of its absolute values.
constexpr double kFromMedian = 1.4826;

}  // namespace

double straight_turning(std::size_t k) {
  constexpr double kRounded = 0.003;
  return std::ldexp(kRounded, -static_cast<int>(k));
}

double usual_turning(std::span<const std::vector<ScaleSignal>> pieces, std::size_t k, bool of_pixels) {
  const double straight = of_pixels ? 0.0 : straight_turning(k);
  std::vector<float> sizes;
  for (const auto& piece : pieces) {
    for (const float t : piece[k].turning)
      if (std::abs(static_cast<double>(t)) > straight) sizes.push_back(std::abs(t));
  }
  return std::max(sizes.empty() ? straight : kFromMedian * static_cast<double>(median(sizes)), 1e-12);
}

Coded encode(const ScaleSignal& signal, double usual) {
  Coded coded;
  std::vector<double> squares;
  coded.forward.values.reserve(signal.turning.size());
  squares.reserve(signal.turning.size());
  for (const float t : signal.turning) {
    const double value = std::clamp(static_cast<double>(t) / usual, -kTurningLimit, kTurningLimit);
    coded.forward.values.push_back(static_cast<float>(value));
    squares.push_back(value * value);
  }
  coded.forward.relief.reserve(squares.size());
  for (const double square : smooth(squares, kReliefReach))
    coded.forward.relief.push_back(static_cast<float>(std::sqrt(std::min(square, 1.0))));
  const std::vector<float>& values = coded.forward.values;
  coded.backward.values.reserve(values.size());
  for (auto t = values.rbegin(); t != values.rend(); ++t) coded.backward.values.push_back(-*t);
  coded.backward.relief.assign(coded.forward.relief.rbegin(), coded.forward.relief.rend());
  return coded;
}

}  // namespace rejoin::outline::detail
