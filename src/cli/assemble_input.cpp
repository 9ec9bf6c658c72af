#include "cli/assemble_input.hpp"

#include <unistd.h>

#include <fmt/core.h>

#include <memory>
#include <system_error>

#include "batch/batch.hpp"
#include "batch/inputs.hpp"
#include "batch/shelf.hpp"
#include "cli/batch_listeners.hpp"
#include "cli/fragment.hpp"
#include "core/error.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace fs = std::filesystem;
namespace {

/// The surface that was matched, or the scan anew where that is gone and cannot be kept (a run that may only be read).
match::Fragment load_one(const store::Fragment& fragment, const fs::path& folder, Console& console,
                         const Context& context) {
  try {
    return batch::load_prepared(fragment, folder / batch::kCacheName, context);
  } catch (const StoreError&) {
    return load_fragment(fragment.path, console, context);
  }
}

/// Numbers of the fragments that could be loaded, by their ids.
std::map<std::int64_t, std::size_t> load_all(const store::Run& run, const fs::path& folder,
                                             AssembleInput& input, Console& console, const Context& context) {
  std::map<std::int64_t, std::size_t> number;
  const std::vector<store::Fragment> fragments = run.fragments();
  const std::map<std::string, std::string> copies = store::copies(fragments);
  for (const store::Fragment& fragment : fragments) {
    if (context.cancelled()) break;
    const auto copy = copies.find(fragment.name);
    if (copy != copies.end()) {
      input.bad[fragment.name] = store::reason_of_copy(copy->second);
      continue;
    }
    if (fragment.state == store::FragmentState::Bad) {
      console.warning(fragment.error);
      input.bad[fragment.name] = fragment.error;
      continue;
    }
    try {
      input.fragments.push_back(load_one(fragment, folder, console, context));
      input.names.push_back(fragment.name);
      input.paths.push_back(fragment.path);
      input.hashes.push_back(fragment.hash);
      number[fragment.id] = input.names.size() - 1;
    } catch (const Error& error) {
      console.warning(error.what());
      input.bad[fragment.name] = error.what();
    }
  }
  return number;
}

AssembleInput read_run(const fs::path& folder, Console& console, const Context& context) {
  const store::Run run = store::Run::open(folder);
  AssembleInput input;
  input.remains = store::remains(run);
  input.warnings = batch::told(batch::changed_scans(run.fragments()), "assembled is");
  const auto number = load_all(run, folder, input, console, context);
  if (input.fragments.size() < 2 && !context.cancelled())
    throw InputError(folder.string(), "fewer than two of its fragments can be used", "see the warnings");
  for (const store::Pair& pair : run.pairs()) {
    const auto a = number.find(pair.a);
    const auto b = number.find(pair.b);
    if (a == number.end() || b == number.end()) continue;
    for (const store::Candidate& candidate : run.candidates(pair)) {
      input.links.push_back({a->second, b->second, candidate.pose, candidate.score});
    }
  }
  return input;
}

/// A folder for a run that nobody wants to keep.
class PassingFolder {
 public:
  PassingFolder() : path_(fs::temp_directory_path() / fmt::format("rejoin-assemble-{}", getpid())) {}
  ~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

AssembleInput match_and_read(const fs::path& scans, const fs::path& run, Console& console,
                             const Context& context) {
  const auto listener = make_console_listener(console);
  const batch::Summary summary = batch::run(scans, run, batch::Options(), *listener, context);
  console.end_progress();
  if (summary.cancelled) return {};
  return read_run(run, console, context);
}

}  // namespace

bool is_run(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / store::kFileName, ignored);
}

std::vector<std::string> names_in(const fs::path& folder) {
  if (!is_run(folder)) return batch::find_scans(folder);
  std::vector<std::string> names;
  for (const store::Fragment& fragment : store::Run::open(folder).fragments()) names.push_back(fragment.name);
  return names;
}

AssembleInput read_assemble_input(const fs::path& folder, const std::optional<fs::path>& keep,
                                  Console& console, const Context& context) {
  if (is_run(folder)) return read_run(folder, console, context);
  if (keep) return match_and_read(folder, *keep, console, context);
  const PassingFolder passing;
  return match_and_read(folder, passing.path(), console, context);
}

}  // namespace rejoin::cli
