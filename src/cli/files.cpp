#include "cli/files.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.hpp"

namespace rejoin::cli {
namespace fs = std::filesystem;
namespace {

fs::path beside(const fs::path& path) {
  return fmt::format("{}.{}.part", path.string(), getpid());
}

bool is_device(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored) && !fs::is_directory(path, ignored);
}

[[noreturn]] void refuse(const fs::path& path, int reason) {
  throw IoError(path.string(), fmt::format("cannot be written ({})", std::strerror(reason)),
                "choose another place");
}

}  // namespace

void require_writable_file(const fs::path& path) {
  if (is_device(path)) {
    if (access(path.c_str(), W_OK) != 0) refuse(path, errno);
    return;
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) refuse(path, EISDIR);
  const fs::path probe = beside(path);
  errno = 0;
  if (!std::ofstream(probe)) refuse(path, errno);
  fs::remove(probe, ignored);
}

void require_writable_folder(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) refuse(folder, problem.value());
  if (!fs::is_directory(folder, problem)) refuse(folder, ENOTDIR);
  const fs::path probe = beside(folder / "probe");
  errno = 0;
  if (!std::ofstream(probe)) refuse(folder, errno);
  fs::remove(probe, problem);
}

void write_file(const fs::path& path, std::string_view content) {
  const bool direct = is_device(path);
  const fs::path target = direct ? path : beside(path);
  errno = 0;
  std::ofstream file(target, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  std::error_code problem;
  if (!file) {
    const int reason = errno;
    if (!direct) fs::remove(target, problem);
    refuse(path, reason);
  }
  if (direct) return;
  fs::rename(target, path, problem);
  if (problem) {
    const int reason = problem.value();
    fs::remove(target, problem);
    refuse(path, reason);
  }
}

}  // namespace rejoin::cli
