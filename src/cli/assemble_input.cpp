#include "cli/assemble_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <system_error>

#include "batch/batch.hpp"
#include "batch/inputs.hpp"
#include "batch/search_pair.hpp"
#include "batch/shelf.hpp"
#include "batch/sizes.hpp"
#include "cli/batch_listeners.hpp"
#include "cli/fragment.hpp"
#include "cli/interrupt.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "match/verify.hpp"
#include "store/results.hpp"
#include "store/run.hpp"

namespace rejoin::cli {
namespace fs = std::filesystem;
namespace {

/// What became of loading a fragment.
struct Loaded {
  std::optional<match::Fragment> fragment;
  std::string error;  ///< of a scan that cannot be used
  bool is_not_kept =
      false;  ///< the surface that was matched is gone and cannot be made again in its place (a run that may only be read)
};

Loaded load_kept(const store::Fragment& fragment, const fs::path& folder, mesh::PieceKind kind,
                 const Context& context) {
  Loaded loaded;
  try {
    loaded.fragment = batch::load_prepared(fragment, folder / batch::kCacheName, kind, context);
  } catch (const StoreError&) {
    loaded.is_not_kept = true;
  } catch (const Error& error) {
    loaded.error = error.what();
  }
  return loaded;
}

/// The surfaces that were matched, side by side.
std::vector<Loaded> load_all_kept(const std::vector<store::Fragment>& fragments, const fs::path& folder,
                                  mesh::PieceKind kind, const Context& context) {
  std::vector<Loaded> loaded(fragments.size());
  std::size_t done = 0;
  std::mutex guard;
  run_side_by_side(fragments.size(), [&](std::size_t k) {
    if (context.cancelled()) return;
    const Context alone({}, context);
    loaded[k] = load_kept(fragments[k], folder, kind, alone);
    const std::lock_guard lock(guard);
    context.report("load", static_cast<double>(++done) / static_cast<double>(fragments.size()));
  });
  return loaded;
}

/// Those that can be assembled; copies and bad ones go to `input.bad`.
std::vector<store::Fragment> usable(const store::Run& run, AssembleInput& input, Console& console) {
  input.copies = run.copies();
  std::vector<store::Fragment> list;
  for (const store::Fragment& fragment : run.fragments()) {
    const auto copy = input.copies.find(fragment.name);
    if (copy != input.copies.end()) {
      input.bad[fragment.name] = store::reason_of_copy(copy->second);
    } else if (fragment.state == store::FragmentState::Bad) {
      console.warning(fragment.error);
      input.bad[fragment.name] = fragment.error;
    } else {
      list.push_back(fragment);
    }
  }
  return list;
}

/// Numbers of the fragments that could be loaded, by their ids.
std::map<std::int64_t, std::size_t> load_all(const store::Run& run, const fs::path& folder,
                                             AssembleInput& input, Console& console, const Context& context) {
  std::map<std::int64_t, std::size_t> number;
  const std::vector<store::Fragment> fragments = usable(run, input, console);
  const mesh::PieceKind kind = batch::kind_of(run.parameters());
  std::vector<Loaded> loaded = load_all_kept(fragments, folder, kind, context);
  console.end_progress();
  for (std::size_t k = 0; k < fragments.size() && !context.cancelled(); ++k) {
    const store::Fragment& fragment = fragments[k];
    try {
      if (loaded[k].is_not_kept) loaded[k].fragment = load_fragment(fragment.path, console, context, kind);
    } catch (const Error& error) {
      loaded[k].error = error.what();
    }
    if (!loaded[k].fragment) {
      console.warning(loaded[k].error);
      input.bad[fragment.name] = loaded[k].error;
      if (fragment.state == store::FragmentState::Ready) input.lost.push_back(fragment.name);
      continue;
    }
    number[fragment.id] = input.names.size();
    input.fragments.push_back(std::move(*loaded[k].fragment));
    input.names.push_back(fragment.name);
    input.paths.push_back(fragment.path);
    input.hashes.push_back(fragment.hash);
  }
  return number;
}

/// Why a pair has no pose.
std::string why_none(const store::Pair& pair) {
  switch (pair.stage) {
    case store::Stage::Apart:
      return "the layout has them too far apart to touch, so they were not searched";
    case store::Stage::Failed:
      return "they could not be compared (pairs.csv of the run says why)";
    case store::Stage::Sweep:
    case store::Stage::Match:
      break;
  }
  return "their search found none";
}

AssembleInput read_run(const fs::path& folder, Console& console, const Context& context) {
  const store::Run run = store::Run::open(folder);
  AssembleInput input;
  input.remains = store::remains(run);
  input.results = store::results_hash(run);
  const std::vector<store::Fragment> fragments = run.fragments();
  input.warnings =
      batch::told(batch::kept_ones(batch::changed_scans(fragments), fragments, folder / batch::kCacheName),
                  "assembled is");
  for (std::string& doubt : batch::doubts_about_lengths(fragments))
    input.warnings.push_back(std::move(doubt));
  const auto number = load_all(run, folder, input, console, context);
  if (input.fragments.size() < 2 && !context.cancelled())
    throw InputError(folder.string(), "fewer than two of its fragments can be used", "see the warnings");
  for (const store::Pair& pair : run.pairs()) {
    const auto a = number.find(pair.a);
    const auto b = number.find(pair.b);
    if (a == number.end() || b == number.end()) continue;
    const bool join = pair.verdict == match::name_of(match::Verdict::Join);
    const std::vector<store::Candidate> candidates = run.candidates(pair);
    if (candidates.empty()) input.without_pose[std::minmax(a->second, b->second)] = why_none(pair);
    for (const store::Candidate& candidate : candidates) {
      // Else only its stability kept the verdict from "join", or it is a later pose: no two of a pair are true.
      const bool holds = (join && candidate.rank == 1) || candidate.score < match::kSure;
      input.links.push_back({a->second, b->second, candidate.pose, candidate.score, holds, candidate.slides});
    }
  }
  return input;
}

/// Makes a folder of our own where the system keeps such.
/// \throws IoError
fs::path make_passing_folder() {
  constexpr const char* kMend = "set TMPDIR to a folder with room, or add --out DIR";
  std::error_code problem;
  const fs::path parent = fs::temp_directory_path(problem);
  if (problem) {
    const char* named = std::getenv("TMPDIR");
    throw IoError(named == nullptr ? "/tmp" : named,
                  fmt::format("cannot hold the run for as long as it is needed ({})", problem.message()),
                  kMend);
  }
  std::string pattern = (parent / "rejoin-assemble-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw IoError(parent.string(),
                  fmt::format("cannot hold the run for as long as it is needed ({})", std::strerror(errno)),
                  kMend);
  }
  return pattern;
}

/// A folder for a run that nobody wants to keep.
class PassingFolder {
 public:
  PassingFolder() : path_(make_passing_folder()), killed_(path_) {}
  ~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  RemoveWhenKilled killed_;
};

AssembleInput match_and_read(const fs::path& scans, const fs::path& run, const batch::Options& matching,
                             Console& console, const Context& context) {
  const auto listener = make_console_listener(console);
  const batch::Summary summary = batch::run(scans, run, matching, *listener, context);
  console.end_progress();
  if (summary.cancelled) return {};
  AssembleInput input = read_run(run, console, context);
  input.failed_now = summary.progress.failed > 0 || !summary.bad.empty();
  return input;
}

}  // namespace

bool is_run(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / store::kFileName, ignored);
}

KnownNames names_in(const fs::path& folder) {
  if (!is_run(folder)) {
    const batch::Scans scans = batch::find_scans(folder);
    return {batch::names_of(scans), store::copies(batch::files_of_equal_size(scans))};
  }
  const store::Run run = store::Run::open(folder);
  KnownNames known{{}, run.copies()};
  for (const store::Fragment& fragment : run.fragments()) known.names.push_back(fragment.name);
  return known;
}

AssembleInput read_assemble_input(const fs::path& folder, const std::optional<fs::path>& keep,
                                  const batch::Options& matching, Console& console, const Context& context) {
  if (is_run(folder)) return read_run(folder, console, context);
  if (keep) return match_and_read(folder, *keep, matching, console, context);
  const PassingFolder passing;
  return match_and_read(folder, passing.path(), matching, console, context);
}

}  // namespace rejoin::cli
