#include "cli/output_stage.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.hpp"
#include "core/files.hpp"

namespace rejoin::cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStageName = "rejoin.part";

/// What a program left that could not end by itself goes.
fs::path made_anew(const fs::path& stage) {
  std::error_code ignored;
  fs::remove_all(stage, ignored);
  require_writable_folder(stage);
  return stage;
}

}  // namespace

// Not closed by exec: what removes a stage after the process has ended (RemoveWhenKilled) holds the folder until it is done.
OutputHold::OutputHold(const fs::path& folder) : folder_(open(folder.c_str(), O_RDONLY | O_DIRECTORY)) {
  if (folder_ < 0 || flock(folder_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(folder_);
  throw IoError(folder.string(), "is written by another rejoin", "wait for its end, or name another folder");
}

OutputHold::~OutputHold() {
  if (folder_ >= 0) close(folder_);
}

OutputStage::OutputStage(const fs::path& folder)
    : folder_(folder), path_(made_anew(folder / kStageName)), killed_(fs::absolute(path_)) {}

OutputStage::~OutputStage() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<fs::path> OutputStage::publish(const std::vector<fs::path>& files) const {
  std::vector<fs::path> published;
  for (const fs::path& file : files) {
    published.push_back(folder_ / file.lexically_relative(path_));
    std::error_code ignored;
    if (!fs::is_directory(file, ignored)) {
      replace_file(file, published.back());
      continue;
    }
    require_writable_folder(published.back());
    for (const fs::directory_entry& entry : fs::directory_iterator(file))
      replace_file(entry.path(), published.back() / entry.path().filename());
  }
  return published;
}

}  // namespace rejoin::cli
