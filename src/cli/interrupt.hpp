/// Ctrl-C, and the other signals that ask a program to end: SIGTERM (kill, timeout, a system that shuts down) and SIGHUP (a terminal
/// that is closed), unless nohup has it ignored.
#pragma once

#include <signal.h>

#include <array>
#include <filesystem>

#include "core/context.hpp"

namespace rejoin::cli {

/// While it lives, the first Ctrl-C asks the work to end (Context::cancel) and the second kills the process.
class Interrupt {
 public:
  /// \param context  outlives this object
  explicit Interrupt(Context& context);
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Of work that was asked to end: 128 and the signal's number, so kInterrupted after Ctrl-C.
  int exit_code() const;

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

/// Marks a stretch of work that cannot be asked to stop and has nothing to save: while it lives, the first
/// Ctrl-C ends the process at once, with the exit code of Interrupt::exit_code().
class NothingToSave {
 public:
  /// \param told  what the user is told then, one line without its end; outlives this
  explicit NothingToSave(const char* told = "interrupted");
  ~NothingToSave();
  NothingToSave(const NothingToSave&) = delete;
  NothingToSave& operator=(const NothingToSave&) = delete;
};

/// Names a folder that is to go, too, where Ctrl-C ends the process at once; one at a time.
class RemoveWhenKilled {
 public:
  explicit RemoveWhenKilled(const std::filesystem::path& folder);
  ~RemoveWhenKilled();
  RemoveWhenKilled(const RemoveWhenKilled&) = delete;
  RemoveWhenKilled& operator=(const RemoveWhenKilled&) = delete;
};

}  // namespace rejoin::cli
