/// Progress and cancellation, handed through every long call.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace rejoin {

/// Carries progress out and the wish to stop in.  Thread-safe.  How a search ended (finished or cancelled) is data
/// in its result, never an exception.
class Context {
 public:
  using Progress = std::function<void(std::string_view stage, double fraction)>;

  Context() = default;
  explicit Context(Progress progress) : progress_(std::move(progress)) {}

  /// For a piece of a longer work: stops when `whole` does.
  /// \param whole  outlives this
  Context(Progress progress, const Context& whole) : progress_(std::move(progress)), whole_(&whole) {}

  /// Tells the listener, if there is one.  fraction: 0 .. 1 of the named stage.  Call from one thread at a time.
  void report(std::string_view stage, double fraction) const {
    if (progress_) progress_(stage, fraction);
  }

  /// Asks the work to end soon (async-signal-safe).
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const {
    return cancelled_.load(std::memory_order_relaxed) || (whole_ != nullptr && whole_->cancelled());
  }

 private:
  Progress progress_;
  const Context* whole_ = nullptr;
  std::atomic<bool> cancelled_{false};
};

}  // namespace rejoin
