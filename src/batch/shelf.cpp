#include "batch/shelf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include "batch/inputs.hpp"
#include "batch/matcher_source.hpp"
#include "batch/painted.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "match/units.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"

namespace rejoin::batch {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLeast = 4;  // faces or points; fewer enclose nothing

void require_body(const mesh::Mesh& scan, const std::string& path) {
  const bool cloud = scan.is_cloud();
  if ((cloud ? scan.vertices.size() : scan.faces.size()) >= kLeast) return;
  throw InputError(path, fmt::format("has fewer than {} {}", kLeast, cloud ? "points" : "faces"),
                   "give the scan of a whole fragment");
}

/// Named after what made it, too: other sources may lay another surface through the same scan.
fs::path kept_file(const store::Fragment& fragment, const fs::path& cache) {
  return cache / fmt::format("{}-{}.drc", fragment.hash, kMatcherSource);
}

/// Surfaces of the scan that other versions or builds made.
std::vector<fs::path> kept_by_others(const store::Fragment& fragment, const fs::path& cache) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(cache, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(fragment.hash) && name.ends_with(".drc") &&
        entry.path() != kept_file(fragment, cache))
      files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::optional<mesh::Mesh> read_if_whole(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  try {
    return mesh::load(file).mesh;
  } catch (const Error&) {
    return std::nullopt;  // cut short by a power failure: made again
  }
}

/// \throws StoreError the folder refuses the file: our disk is at fault, not the scan
void keep(const fs::path& kept, const mesh::Mesh& surface) {
  try {
    require_writable_folder(kept.parent_path());
    mesh::save(kept, surface);
  } catch (const IoError& error) {
    throw StoreError(kept.string(), "a prepared scan cannot be kept",
                     fmt::format("free some space and run the command again ({})", error.what()));
  }
}

/// \throws InputError the scan is no longer what the run knows, or cannot be used
mesh::Mesh read_and_keep(const store::Fragment& fragment, const fs::path& cache,
                         std::vector<std::string>& warnings) {
  mesh::Loaded loaded = mesh::load(fragment.path);
  if (content_hash(fragment.path) != fragment.hash) {
    throw InputError(fragment.path, "has another content than rejoin batch found, of which nothing is kept",
                     "run rejoin batch again");
  }
  warnings = std::move(loaded.warnings);
  require_body(loaded.mesh, fragment.path);
  const mesh::Mesh surface = match::surface_of(fragment.path, std::move(loaded.mesh));
  keep(kept_file(fragment, cache), surface);
  std::optional<mesh::Mesh> kept = read_if_whole(kept_file(fragment, cache));
  if (!kept) return mesh::as_kept(surface, fragment.path);  // tells what is wrong with it
  std::error_code ignored;
  for (const fs::path& file : kept_by_others(fragment, cache)) fs::remove(file, ignored);
  return std::move(*kept);
}

struct Outcome {
  store::Fragment fragment;
  std::unique_ptr<const match::Fragment> prepared;
};

Outcome prepare_one(const store::Fragment& fragment, const fs::path& cache, mesh::PieceKind kind,
                    const Context& context) {
  Outcome outcome{fragment, nullptr};
  store::Fragment& record = outcome.fragment;
  try {
    outcome.prepared = std::make_unique<const match::Fragment>(load_prepared(fragment, cache, kind, context));
    record.faces = static_cast<std::int64_t>(outcome.prepared->surface.faces.size());
    const match::Lengths lengths = match::lengths_of(*outcome.prepared);
    record.diameter = lengths.diameter;
    record.spacing = lengths.spacing;
    record.noise = lengths.noise;
    record.wall = lengths.wall;
    record.state = store::FragmentState::Ready;
    record.error.clear();
  } catch (const StoreError&) {
    throw;
  } catch (const Error& error) {
    record.state = store::FragmentState::Bad;
    record.error = error.what();
    // Whatever it held before: so that it is tried again as soon as it can be read.
    if (hash_if_readable(fragment.path) == store::kUnreadable) record.hash = store::kUnreadable;
  } catch (const std::bad_alloc&) {
    record.state = store::FragmentState::Bad;
    record.error = fragment.path + ": out of memory; use a smaller scan";
  }
  return outcome;
}

}  // namespace

std::optional<mesh::Mesh> kept_surface(const store::Fragment& fragment, const fs::path& cache) {
  std::optional<mesh::Mesh> kept = read_if_whole(kept_file(fragment, cache));
  if (kept) return kept;
  for (const fs::path& file : kept_by_others(fragment, cache)) {
    kept = read_if_whole(file);
    if (kept) break;
  }
  return kept;
}

ChangedScans kept_ones(const ChangedScans& scans, const std::vector<store::Fragment>& fragments,
                       const fs::path& cache) {
  std::set<std::string> kept;
  std::error_code ignored;
  for (const store::Fragment& fragment : fragments) {
    if (fs::is_regular_file(kept_file(fragment, cache), ignored) || !kept_by_others(fragment, cache).empty())
      kept.insert(fragment.name);
  }
  ChangedScans result;
  const auto is_kept = [&kept](const std::string& name) { return kept.count(name) != 0; };
  std::ranges::copy_if(scans.gone, std::back_inserter(result.gone), is_kept);
  std::ranges::copy_if(scans.changed, std::back_inserter(result.changed), is_kept);
  return result;
}

void gather_surfaces(const std::vector<fs::path>& caches, const fs::path& cache) {
  try {
    require_writable_folder(cache);
    for (const fs::path& from : caches) {
      if (!fs::is_directory(from)) continue;
      for (const auto& entry : fs::directory_iterator(from)) {
        const fs::path to = cache / entry.path().filename();
        const bool whole =
            entry.is_regular_file() && to.extension() != ".part";  // of a write that was cut off
        if (!whole || fs::exists(to)) continue;
        std::error_code other_disk;
        fs::create_hard_link(entry.path(), to, other_disk);
        if (!other_disk) continue;
        std::ifstream content(entry.path(), std::ios::binary);
        write_file(to, [&content](std::ostream& out) { out << content.rdbuf(); });
      }
    }
  } catch (const std::exception& error) {
    throw StoreError(cache.string(), "prepared scans cannot be kept",
                     fmt::format("free some space and run the command again ({})", error.what()));
  }
}

match::Fragment load_prepared(const store::Fragment& fragment, const fs::path& cache, mesh::PieceKind kind,
                              const Context& context) {
  std::vector<std::string> warnings;
  std::optional<mesh::Mesh> surface = read_if_whole(kept_file(fragment, cache));
  if (!surface && hash_if_readable(fragment.path) != fragment.hash) surface = kept_surface(fragment, cache);
  if (!surface) surface = read_and_keep(fragment, cache, warnings);
  match::Fragment prepared = match::prepare(fragment.path, std::move(*surface), context, kind);
  prepared.warnings.insert(prepared.warnings.begin(), warnings.begin(), warnings.end());
  if (!fragment.facets.empty()) use_kept_paint(prepared, fragment, cache);
  return prepared;
}

void Shelf::hold(const std::vector<store::Fragment>& wanted, const Context& context, const Told& told) {
  std::map<std::string, std::unique_ptr<const match::Fragment>> kept;
  std::vector<store::Fragment> missing;
  for (const store::Fragment& fragment : wanted) {
    const auto here = held_.find(fragment.name);
    if (here != held_.end()) {
      kept.emplace(fragment.name, std::move(here->second));
    } else if (fragment.state != store::FragmentState::Bad) {
      missing.push_back(fragment);
    }
  }
  held_ = std::move(kept);
  std::mutex guard;
  run_side_by_side(missing.size(), [&](std::size_t k) {
    if (context.cancelled()) return;
    const Context alone({}, context);
    Outcome outcome = prepare_one(missing[k], cache_, kind_, alone);
    const std::lock_guard lock(guard);
    const std::vector<std::string> warnings =
        outcome.prepared ? outcome.prepared->warnings : std::vector<std::string>{};
    if (outcome.prepared) held_.emplace(outcome.fragment.name, std::move(outcome.prepared));
    told(outcome.fragment, warnings);
  });
}

const match::Fragment* Shelf::find(const std::string& name) const {
  const auto here = held_.find(name);
  return here == held_.end() ? nullptr : here->second.get();
}

}  // namespace rejoin::batch
