/// The project's values as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "core/rigid.hpp"

namespace rejoin::cli {

inline nlohmann::ordered_json to_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// 4 x 4, row major.
inline nlohmann::ordered_json to_json(const Rigid& pose) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back(
        {pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row], pose.translation[row]});
  }
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

}  // namespace rejoin::cli
