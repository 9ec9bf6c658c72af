#include "outline/detail/turn_model.hpp"

#include <algorithm>
#include <cmath>

namespace rejoin::outline::detail {
namespace {

constexpr double kLevelDeg = 0.1;
constexpr int kZero = TurnModel::kLevels / 2;
constexpr double kBend = 0.15;  // share of a bend by which two scans of it differ, as their samples lie apart
constexpr double kOutliers = 0.1;  // share of samples that say nothing: damage

/// Share of the samples at each level, smoothed so that no level is impossible.
std::vector<double> background(std::span<const std::vector<float>> changes_deg) {
  std::vector<double> counts(TurnModel::kLevels, 1.0);
  double sum = TurnModel::kLevels;
  for (const std::vector<float>& border : changes_deg) {
    for (const float change : border) {
      counts[static_cast<std::size_t>(TurnModel::level(change))] += 0.5;
      counts[static_cast<std::size_t>(TurnModel::level(-change))] += 0.5;
      sum += 1.0;
    }
  }
  std::vector<double> shares(TurnModel::kLevels);
  for (int level = 0; level < TurnModel::kLevels; ++level) {
    double near = 0.0;
    double weights = 0.0;
    for (int k = -2; k <= 2; ++k) {
      const int at = level + k;
      if (at < 0 || at >= TurnModel::kLevels) continue;
      near += (3 - std::abs(k)) * counts[static_cast<std::size_t>(at)];
      weights += 3 - std::abs(k);
    }
    shares[static_cast<std::size_t>(level)] = near / weights / sum;
  }
  return shares;
}

}  // namespace

int TurnModel::level(float change_deg) {
  return std::clamp(static_cast<int>(std::lround(change_deg / kLevelDeg)) + kZero, 0, kLevels - 1);
}

TurnModel::TurnModel(std::span<const std::vector<float>> changes_deg, double tolerance_deg)
    : scores_(static_cast<std::size_t>(kLevels) * kLevels) {
  const std::vector<double> any = background(changes_deg);
  for (int a = 0; a < kLevels; ++a) {
    std::vector<double> same(kLevels);
    double sum = 0.0;
    const double deviation = tolerance_deg + kBend * kLevelDeg * std::abs(a - kZero);
    for (int b = 0; b < kLevels; ++b) {
      const double off = kLevelDeg * (a - b) / deviation;
      sum += same[static_cast<std::size_t>(b)] = std::exp(-0.5 * off * off);
    }
    for (int b = 0; b < kLevels; ++b) {
      const double ratio = same[static_cast<std::size_t>(b)] / sum / any[static_cast<std::size_t>(b)];
      scores_[index(a, b)] =
          static_cast<std::int16_t>(std::lround(kUnit * std::log((1.0 - kOutliers) * ratio + kOutliers)));
    }
  }
}

}  // namespace rejoin::outline::detail
