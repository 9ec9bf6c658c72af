/// How much more likely two slope changes are to be of one place than of any two.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace rejoin::outline::detail {

/// Logarithm of the ratio of two probabilities: that a sample of B looks so beside this sample of A if both are scans of one
/// line, and that any sample of the set looks so.  So straight beside straight says little and a sharp bend beside its
/// like says much, and what is common in a set says less than what is rare.
class TurnModel {
 public:
  static constexpr int kLevels = 255;   ///< of slope changes
  static constexpr double kUnit = 8.0;  ///< values are in eighths of a natural logarithm's unit

  /// \param changes_deg    the slope changes of all borders of a set
  /// \param tolerance_deg  deviation between two scans of a straight line; bends add to it
  TurnModel(std::span<const std::vector<float>> changes_deg, double tolerance_deg);
  TurnModel() = default;

  /// Level of a slope change, 0 .. kLevels - 1.
  static int level(float change_deg);

  /// In units of 1 / kUnit.
  int score(int level_a, int level_b) const { return scores_[index(level_a, level_b)]; }

  /// Scores beside one level of A, by the level of B.
  const std::int16_t* row(int level_a) const { return &scores_[index(level_a, 0)]; }

 private:
  static std::size_t index(int a, int b) {
    return static_cast<std::size_t>(a) * kLevels + static_cast<std::size_t>(b);
  }
  std::vector<std::int16_t> scores_;
};

}  // namespace rejoin::outline::detail
