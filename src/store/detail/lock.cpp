#include "store/detail/lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.hpp"

namespace rejoin::store::detail {

WriteLock::WriteLock(const std::string& path)
    : file_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (file_ < 0) {
    throw StoreError(path, fmt::format("cannot be made ({})", std::strerror(errno)),
                     "check the folder, its permissions and its space");
  }
  if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(file_);
  if (reason == EWOULDBLOCK) {
    throw StoreError(path, "is held by another rejoin that works on this run", "wait for its end");
  }
  throw StoreError(path, fmt::format("cannot be locked ({})", std::strerror(reason)),
                   "put the run on a file system with locks");
}

WriteLock::~WriteLock() {
  close(file_);
}

}  // namespace rejoin::store::detail
