#include "core/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/utf8.hpp"

namespace rejoin {
namespace fs = std::filesystem;
namespace {

/// A name beside `path` that no other process and no other thread of this one uses.
fs::path beside(const fs::path& path) {
  static std::atomic<unsigned> count{0};
  fs::path result = path;
  result += '.';
  result += std::to_string(getpid());
  result += '.';
  result += std::to_string(count++);
  result += ".part";
  return result;
}

/// Whether the name is one that the system gives an open file, as /dev/stderr and /dev/fd/3 lead to: what is written to it must
/// not replace that file.
bool is_open_file(const fs::path& path) {
  std::error_code ignored;
  return fs::weakly_canonical(path.parent_path(), ignored).string().starts_with("/proc/");
}

/// Where links lead, whether there is something or not: who writes to a link means that.
fs::path target_of(fs::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code problem;
  for (int k = 0; k < kMostLinks && !is_open_file(path) && fs::is_symlink(path, problem); ++k) {
    const fs::path next = fs::read_symlink(path, problem);
    if (problem) break;
    path = path.parent_path() / next;
  }
  return path;
}

/// What is written to as it is, with nothing beside it to be renamed.
bool is_device(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) &&
         (is_open_file(path) || (!fs::is_regular_file(path, ignored) && !fs::is_directory(path, ignored)));
}

[[noreturn]] void refuse(const fs::path& path, int reason) {
  throw IoError(path.string(), std::string("cannot be written (") + std::strerror(reason) + ")",
                reason == ENAMETOOLONG
                    ? "choose a shorter name"
                    : "check the folder, its permissions and its space, or choose another place");
}

/// A file that its user has protected stays, though its folder would let another take its name.
void refuse_protected(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored) && access(path.c_str(), W_OK) != 0) refuse(path, errno);
}

/// Who may read and write a file may do so with what takes its place.
void keep_mode(const fs::path& made, const fs::path& replaced) {
  std::error_code absent;
  const fs::perms mode = fs::status(replaced, absent).permissions();
  if (fs::is_regular_file(replaced, absent)) fs::permissions(made, mode & fs::perms::all, absent);
}

/// Waits until the disk holds the file's content: a name given before may outlive a power cut without it, and a full disk
/// behind a network is told by then only.  \return 0, or the system's reason
int flush_to_disk(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return errno == EACCES ? 0 : errno;                    // where new files may not be read
  const int reason = fsync(file) == 0 || errno == EINVAL ? 0 : errno;  // EINVAL: a file system that cannot
  close(file);
  return reason;
}

}  // namespace

bool is_stdout(const fs::path& path) {
  return path == kStdout || path == "/dev/stdout";
}

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string read_file(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw IoError(path.string(), "is a folder", "name a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw IoError(path.string(), std::string("cannot be opened (") + std::strerror(errno) + ")",
                  "check the path and its permissions");
  }
  std::string bytes;
  file.seekg(0, std::ios::end);
  if (const std::streamoff size = file.tellg(); size >= 0) {
    bytes.resize(static_cast<std::size_t>(size));
    file.seekg(0);
    file.read(bytes.data(), size);
  } else {  // a pipe has no size
    file.clear();
    std::ostringstream all;
    if (file.peek() != std::ifstream::traits_type::eof()) all << file.rdbuf();
    bytes = std::move(all).str();
  }
  if (file.bad() || (file.fail() && !bytes.empty()))
    throw IoError(path.string(), "cannot be read", "check the disk or copy the file again");
  return bytes;
}

std::string read_named_file(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw IoError(path.string(), "is a folder, pipe or device", "put the file itself there");
  return read_file(path);
}

void require_writable_file(const fs::path& name) {
  if (is_stdout(name)) return;
  const fs::path path = target_of(name);
  if (is_device(path)) {
    if (access(path.c_str(), W_OK) != 0) refuse(path, errno);
    return;
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) refuse(path, EISDIR);
  refuse_protected(path);
  const fs::path probe = beside(path);
  errno = 0;
  if (!std::ofstream(probe)) refuse(path, errno);
  fs::remove(probe, ignored);
}

void require_tellable_name(const fs::path& path) {
  const std::string name = path.filename().string();
  if (!is_utf8(name)) {
    throw InputError(valid_utf8(path.string()), "has a name that is no UTF-8, so that no result can tell it",
                     "rename the file (convmv renames whole folders)");
  }
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(name, is_control))
    throw InputError(path.string(), "has a line end, tab or other control character in its name",
                     "rename the file");
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

void require_empty_folder(const fs::path& folder) {
  require_writable_folder(folder);
  std::error_code ignored;
  if (!fs::is_empty(folder, ignored))
    throw IoError(folder.string(), "the folder is not empty", "name a new or empty folder");
}

void write_file(const fs::path& path, std::string_view content) {
  write_file(path, [content](std::ostream& out) {
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
  });
}

void write_file(const fs::path& name, const std::function<void(std::ostream&)>& write) {
  if (is_stdout(name)) {
    errno = 0;
    write(std::cout);
    if (!std::cout.flush()) refuse("standard output", errno);
    return;
  }
  const fs::path path = target_of(name);
  const bool direct = is_device(path);
  const fs::path target = direct ? path : beside(path);
  if (!direct) refuse_protected(path);
  errno = 0;
  std::ofstream file(target, std::ios::binary);
  if (file && !direct) keep_mode(target, path);
  std::error_code problem;
  try {
    write(file);
  } catch (...) {
    if (!direct) fs::remove(target, problem);
    throw;
  }
  file.close();
  if (!file) {
    const int reason = errno;
    if (!direct) fs::remove(target, problem);
    refuse(path, reason);
  }
  if (direct) return;
  int reason = flush_to_disk(target);
  if (reason == 0 && std::rename(target.c_str(), path.c_str()) != 0) reason = errno;
  if (reason == 0) return;
  fs::remove(target, problem);
  refuse(path, reason);
}

void replace_file(const fs::path& made, const fs::path& name) {
  const fs::path path = target_of(name);
  if (is_device(path) || path != name) {  // who has a link there means what it leads to
    write_file(path, read_file(made));
    return;
  }
  refuse_protected(path);
  keep_mode(made, path);
  if (std::rename(made.c_str(), path.c_str()) != 0) refuse(path, errno);
}

}  // namespace rejoin
