#include "cli/outputs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "batch/shelf.hpp"
#include "batch/table.hpp"
#include "cli/assemble_input.hpp"
#include "cli/command.hpp"
#include "core/files.hpp"
#include "mesh/load.hpp"
#include "outline/read.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace fs = std::filesystem;
namespace {

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code absent;
  return fs::equivalent(a, b, absent);
}

/// Whether a command reads files of such a name from a folder that it is given.
bool is_read_from_folders(const fs::path& file, const CLI::App& command) {
  const bool flat = command.get_parent() != nullptr && command.get_parent()->get_name() == "outline";
  return flat ? outline::has_piece_name(file.string()) : mesh::has_scan_name(file);
}

[[noreturn]] void refuse(const std::string& option, const fs::path& output) {
  throw UsageError(output.string(), "is read too and would be lost",
                   fmt::format("give {} another place", option));
}

/// Whether writing `output` takes something of `input`, a file or a folder.
bool would_destroy(const fs::path& output, const fs::path& input, const CLI::App& command) {
  std::error_code ignored;
  if (!fs::is_regular_file(output, ignored)) return false;
  if (is_same(output, input)) return true;
  const auto is_read = [&](const fs::path& file) {
    return is_read_from_folders(file, command) && is_same(file.parent_path(), input);
  };
  return fs::is_directory(input, ignored) &&
         (is_read(fs::absolute(output)) || is_read(fs::canonical(output, ignored)));
}

bool has_name_of_a_file(const fs::path& path) {
  constexpr std::array kEndings{".json", ".html", ".csv", ".png", ".ply", ".glb", ".obj"};
  const std::string ending = extension_of(path);
  return std::ranges::any_of(kEndings, [&](const char* known) { return ending == known; });
}

std::vector<std::string> values_of(const CLI::App& command, const std::string& group) {
  std::vector<std::string> values;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group() != group) continue;
    values.insert(values.end(), option->results().begin(), option->results().end());
  }
  return values;
}

void require_file(const CLI::Option& option, const std::string& value, const CLI::App& command) {
  for (const std::string& input : values_of(command, "Input")) {
    if (would_destroy(value, input, command)) refuse(option.get_name(), value);
  }
}

bool is_file_output(const CLI::Option& option) {
  return option.get_group() == "Output" && option.get_type_name() == "FILE";
}

/// Devices and pipes take several outputs, a file the last one alone.
void require_different_files(const CLI::App& command) {
  std::map<fs::path, std::string> option_of;
  for (const CLI::Option* option : command.get_options()) {
    if (!is_file_output(*option)) continue;
    for (const std::string& value : option->results()) {
      std::error_code ignored;
      const fs::path file =
          fs::weakly_canonical(fs::absolute(value), ignored);  // of a new file else as it is written
      if (fs::is_other(file, ignored)) continue;
      const auto [earlier, first] = option_of.emplace(file, option->get_name());
      if (!first)
        throw UsageError(value, fmt::format("is given to {} and to {}", earlier->second, option->get_name()),
                         "name a file for each");
    }
  }
}

void require_folder(const CLI::Option& option, const std::string& value) {
  std::error_code ignored;
  if (fs::is_directory(value, ignored) || !has_name_of_a_file(value)) return;
  throw UsageError(value, fmt::format("has the name of a file, but {} takes a folder", option.get_name()),
                   "name a folder");
}

}  // namespace

void require_apart(const std::string& option, const fs::path& output, const fs::path& input) {
  std::error_code ignored;
  if (fs::is_regular_file(output, ignored) && is_same(output, input)) refuse(option, output);
}

void require_apart_from_outputs(const std::string& option, const std::optional<std::string>& output,
                                const std::vector<fs::path>& files) {
  const auto place = [](const fs::path& path) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(path), ignored);
  };
  const bool any =
      output && std::ranges::any_of(files, [&](const auto& file) { return place(file) == place(*output); });
  if (any) throw UsageError(*output, "is written by --out, too", fmt::format("give {} another name", option));
}

OutputFolder::OutputFolder(const fs::path& path) : path_(path), exceptions_(std::uncaught_exceptions()) {
  std::error_code ignored;
  made_ = !fs::exists(path, ignored);
  require_empty_folder(path);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (std::uncaught_exceptions() > exceptions_) {
    for (const fs::path& file : files_) fs::remove(file, ignored);
  }
  if (made_) fs::remove(path_, ignored);  // unless it holds something
}

fs::path OutputFolder::file(const std::string& name) {
  files_.push_back(path_ / name);
  return files_.back();
}

void OutputFolder::add(const fs::path& file) {
  std::error_code ignored;
  if (fs::equivalent(fs::absolute(file).parent_path(), path_, ignored)) files_.push_back(file);
}

void require_apart_from_run(const std::string& option, const fs::path& output, const fs::path& run,
                            const std::string& replaceable) {
  std::error_code ignored;
  if (!fs::is_regular_file(output, ignored) || !is_run(run)) return;
  const std::string name = fs::canonical(output, ignored).filename().string();
  const fs::path folder = fs::canonical(output, ignored).parent_path();
  const bool is_own = name.starts_with(store::kFileName) ||  // and what SQLite keeps beside it
                      name == batch::kTableName || name == kAssemblyName;
  if (is_same(folder, run / batch::kCacheName) || (is_own && name != replaceable && is_same(folder, run)))
    throw UsageError(output.string(), "belongs to the run and would be lost",
                     fmt::format("give {} another place", option));
  for (const store::Fragment& fragment : store::Run::open(run).fragments())
    require_apart(option, output, fragment.path);
}

void require_ending(const std::string& option, const std::optional<std::string>& file,
                    const std::string& ending) {
  if (!file || fs::path(*file).extension() == ending) return;
  throw UsageError(option, fmt::format("'{}' does not end in {}", *file, ending),
                   fmt::format("name a {} file", ending));
}

bool keeps_earlier(const std::filesystem::path& output, const std::vector<std::filesystem::path>& files,
                   const char* earlier, Console& console) {
  const bool any = std::ranges::any_of(files, [](const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored);
  });
  if (any) console.warning(fmt::format("{} is kept as an earlier {} wrote it", output.string(), earlier));
  return any;
}

void require_sound_paths(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const bool is_empty =
        std::ranges::any_of(option->results(), [](const auto& value) { return value.empty(); });
    if (option->get_group() == "Input" && is_empty)
      throw UsageError(option->get_name(), "is empty", "name what is to be read");
    const std::string type = option->get_type_name();
    if (option->get_group() != "Output" || (type != "FILE" && type != "DIR" && type != "RUN")) continue;
    for (const std::string& value : option->results()) {
      if (value.empty()) throw UsageError(option->get_name(), "has no name", "name what is to be written");
      if (type == "FILE") {
        require_file(*option, value, command);
      } else {
        require_folder(*option, value);
      }
    }
  }
  require_different_files(command);
  for (const CLI::App* used : command.get_subcommands()) require_sound_paths(*used);
}

}  // namespace rejoin::cli
