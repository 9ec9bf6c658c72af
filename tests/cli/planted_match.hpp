/// What the tests of rejoin match share.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "planted_files.hpp"

namespace rejoin::cli::testing {

/// Runs of rejoin match on the two pieces of a block cut along a known surface.
class MatchOfPlanted : public ::testing::Test, protected PlantedFiles {
 protected:
  /// What a run writes with --json.
  nlohmann::ordered_json result_of(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--json", json});
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return nlohmann::ordered_json::parse(read_file(json));
  }

  /// A vector as an option takes it.
  static std::string text(const glm::dvec3& v) {
    return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
  }

  /// The arguments of a search that is quick because it knows the direction of the break.
  std::vector<std::string> quick(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{
        "match", a, b, "--direction-a", text(pair.direction_a), "--direction-b", text(pair.direction_b)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

}  // namespace rejoin::cli::testing
