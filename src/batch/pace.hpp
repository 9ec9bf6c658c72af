/// How long the rest will take.
#pragma once

#include <chrono>
#include <cstddef>

namespace rejoin::batch {

/// Tells the time left by the mean of what is done since start().
class Pace {
 public:
  void start() { begin_ = std::chrono::steady_clock::now(); }

  /// \param left  items to do   \return seconds
  double done_one(std::size_t left) {
    ++done_;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
    return spent.count() / static_cast<double>(done_) * static_cast<double>(left);
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::size_t done_ = 0;
};

}  // namespace rejoin::batch
