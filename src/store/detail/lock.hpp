/// One writer at a time.
#pragma once

#include <string>

namespace rejoin::store::detail {

/// The lock's file in the run's folder.
inline constexpr const char* kLockName = "lock";

/// Holds RUN/lock while it lives.  The system lets go of it when the process ends, however it ends.
class WriteLock {
 public:
  /// \param path  of the lock file, made if it is not there
  /// \throws StoreError another process holds it, or the file cannot be made
  explicit WriteLock(const std::string& path);
  ~WriteLock();
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

 private:
  int file_;
};

}  // namespace rejoin::store::detail
