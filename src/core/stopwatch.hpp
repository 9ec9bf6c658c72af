/// Where the time of a longer work goes.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace rejoin {

struct StageTime {
  std::string stage;
  double seconds = 0;  ///< wall time
};

/// Appends a stage at every lap().
class Stopwatch {
 public:
  /// Starts the first stage.
  /// \param stages  outlives this
  explicit Stopwatch(std::vector<StageTime>& stages) : stages_(stages) {}

  /// Ends the stage that ran until now, and starts the next one.
  void lap(std::string stage) {
    const auto now = std::chrono::steady_clock::now();
    stages_.push_back({std::move(stage), std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

 private:
  std::vector<StageTime>& stages_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace rejoin
