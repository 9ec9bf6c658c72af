/// Angles are radians where no name ends with _deg.
#pragma once

#include <numbers>

namespace rejoin {

inline constexpr double kTurn = 2.0 * std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace rejoin
