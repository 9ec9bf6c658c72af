/// Ctrl-C.
#pragma once

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
};

/// Marks a stretch of work that cannot be asked to stop and has nothing to save: while it lives, the first
/// Ctrl-C ends the process at once with exit code 130.
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
