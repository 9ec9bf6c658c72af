#include "batch/inputs.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <set>

#include "batch/painted.hpp"
#include "batch/shelf.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/words.hpp"
#include "mesh/files.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "store/run.hpp"

namespace rejoin::batch {
namespace fs = std::filesystem;
namespace {

/// Formats of scans that mesh::load() does not know.
constexpr std::array kForeign{".3ds", ".3mf", ".asc", ".blend", ".ctm",  ".dae",  ".e57", ".fbx", ".las",
                              ".laz", ".pcd", ".ptx", ".usd",   ".usdz", ".vrml", ".wrl", ".x3d", ".zpr"};

bool is_scan(const fs::directory_entry& entry) {
  std::error_code ignored;
  if (entry.is_directory(ignored) || entry.is_other(ignored)) return false;  // a pipe would be waited for
  if (entry.path().filename().string().starts_with('.'))
    return false;  // hidden, as macOS leaves one beside every file
  if (std::ranges::find(mesh::kSceneNames, entry.path().filename()) != mesh::kSceneNames.end()) return false;
  return mesh::has_scan_name(entry.path());
}

/// The files in a folder, not below it, that have names of scans.
std::vector<fs::path> files_in(const fs::path& folder, std::error_code& problem) {
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    if (is_scan(*entry)) files.push_back(entry->path());
  }
  return files;
}

/// The painted surfaces of the others, which rejoin facets wrote.
std::set<std::string> painted_of(const std::vector<fs::path>& files) {
  std::set<std::string> names;
  for (const fs::path& file : files) names.insert(painted_name(file.filename().string()));
  std::set<std::string> painted;
  for (const fs::path& file : files) {
    if (names.count(file.filename().string()) > 0) painted.insert(file.filename().string());
  }
  return painted;
}

/// The scans in a folder, not below it.
std::vector<fs::path> scans_in(const fs::path& folder, std::error_code& problem) {
  std::vector<fs::path> files = files_in(folder, problem);
  const std::set<std::string> painted = painted_of(files);
  std::erase_if(files, [&](const fs::path& file) { return painted.count(file.filename().string()) > 0; });
  return files;
}

/// Whether it is the folder in which the run around it keeps its surfaces.
bool is_cache(const fs::path& folder) {
  std::error_code ignored;
  return folder.filename() == kCacheName && fs::exists(folder.parent_path() / store::kFileName, ignored);
}

/// Visits what is in a folder and in all folders below, however deep; not those below links, hidden ones and caches.
template <class Visit>
void for_each_below(const fs::path& folder, const Visit& visit) {
  std::error_code problem;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, problem);
  for (const fs::recursive_directory_iterator end; !problem && entry != end; entry.increment(problem)) {
    if (entry->path().filename().string().starts_with('.') || is_cache(entry->path())) {
      entry.disable_recursion_pending();
    } else {
      visit(*entry);
    }
  }
}

/// Scans by the folder that holds them, of all folders below.
std::map<fs::path, std::vector<fs::path>> scans_below(const fs::path& folder) {
  std::map<fs::path, std::vector<fs::path>> scans;
  for_each_below(folder, [&](const fs::directory_entry& entry) {
    std::error_code ignored;
    if (!entry.is_directory(ignored)) return;
    std::vector<fs::path> files = scans_in(entry.path(), ignored);
    if (!files.empty()) scans[entry.path()] = std::move(files);
  });
  return scans;
}

/// The scans of a folder that holds folders of one scan each, however deep, by these folders' names.
/// \throws InputError one of them holds several
Scans scan_a_folder(const fs::path& folder) {
  Scans scans;
  for (const auto& [path, files] : scans_below(folder)) {
    const fs::path child = *path.lexically_relative(folder).begin();
    if (files.size() > 1 || !scans.emplace(child.string(), files.front()).second) {
      throw InputError((folder / child).string(), "holds several scans",
                       "give it alone, or leave one scan in every folder beside it");
    }
  }
  return scans;
}

/// With those that no result can tell.
/// \throws IoError the folder cannot be read   \throws InputError as scan_a_folder()
Scans all_scans(const fs::path& folder) {
  std::error_code problem;
  Scans scans;
  for (const fs::path& file : scans_in(folder, problem)) scans[file.filename().string()] = file;
  if (problem) {
    throw IoError(folder.string(), fmt::format("cannot be read ({})", problem.message()),
                  "give the folder of the scans");
  }
  return scans.empty() ? scan_a_folder(folder) : scans;
}

std::vector<store::Fragment> untellable_among(const Scans& scans, const fs::path& folder) {
  std::vector<store::Fragment> list;
  for (const auto& [name, file] : scans) {
    try {
      require_tellable_name(folder / name);
    } catch (const InputError& error) {
      list.emplace_back();
      list.back().name = name;
      list.back().path = file.string();
      list.back().state = store::FragmentState::Bad;
      list.back().error = error.what();
    }
  }
  return list;
}

void add_bytes(const fs::path& path, XXH3_state_t& state) {
  const auto refuse = [&path](int reason) {
    throw IoError(path.string(), fmt::format("cannot be read ({})", std::strerror(reason)),
                  "check the file and its permissions");
  };
  std::error_code ignored;
  if (fs::is_other(path, ignored)) throw IoError(path.string(), "is a pipe or device", "name a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(errno);
  std::vector<char> block(1U << 20U);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    XXH3_128bits_update(&state, block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) refuse(errno);
}

}  // namespace

Scans find_scans(const fs::path& folder) {
  Scans scans = all_scans(folder);
  const std::vector<store::Fragment> untellable = untellable_among(scans, folder);
  for (const store::Fragment& scan : untellable) scans.erase(scan.name);
  if (scans.size() < 2) {
    if (!untellable.empty()) require_tellable_name(folder / untellable.front().name);
    std::string mend = "give a folder of ply, obj, stl, off, gltf, glb, drc, xyz or pts files";
    if (fs::exists(folder / store::kFileName)) mend = "it is a run: give the folder of its scans";
    if (!scans.empty() && !scans_below(folder).empty())
      mend = "put all scans into one folder, or each into a folder of its own";
    throw InputError(folder.string(), scans.empty() ? "holds no scan" : "holds one scan only", mend);
  }
  return scans;
}

std::vector<store::Fragment> untellable_scans(const fs::path& folder) {
  return untellable_among(all_scans(folder), folder);
}

std::vector<std::string> names_of(const Scans& scans) {
  std::vector<std::string> names;
  names.reserve(scans.size());
  for (const auto& [name, file] : scans) names.push_back(name);
  return names;
}

std::string told_of_models(const fs::path& folder) {
  std::string names;
  for (const char* model : mesh::kSceneNames) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / model, ignored))
      names += fmt::format("{}{}", names.empty() ? "" : ", ", model);
  }
  if (names.empty()) return "";
  return fmt::format(
      "{}: left out, as rejoin writes models of several fragments under such names (a scan needs another)",
      names);
}

std::string told_of_painted(const fs::path& folder) {
  std::error_code ignored;
  std::set<std::string> painted = painted_of(files_in(folder, ignored));
  if (scans_in(folder, ignored).empty()) {
    for_each_below(folder, [&](const fs::directory_entry& entry) {
      if (!entry.is_directory(ignored)) return;
      for (const std::string& name : painted_of(files_in(entry.path(), ignored)))
        painted.insert((entry.path().lexically_relative(folder) / name).string());
    });
  }
  if (painted.empty()) return "";
  return fmt::format(
      "{} in {} ({}{}) taken for no scan: rejoin facets writes painted breaks under such names, "
      "which --facets DIR uses (a scan needs another)",
      counted(painted.size(), "file"), folder.string(), *painted.begin(), painted.size() == 1 ? "" : ", ...");
}

std::string told_of_folders(const fs::path& folder) {
  std::error_code ignored;
  if (scans_in(folder, ignored).empty()) return "";
  const auto below = scans_below(folder);
  if (below.empty()) return "";
  return fmt::format(
      "{} with scans below {} ({}{}) left out: move those scans up that are to be matched, too, each under a "
      "name of its own",
      counted(below.size(), "folder"), folder.string(),
      below.begin()->first.lexically_relative(folder).string(), below.size() == 1 ? "" : ", ...");
}

std::string told_of_formats(const fs::path& folder) {
  std::set<std::string> names;
  for_each_below(folder, [&](const fs::directory_entry& entry) {
    std::error_code ignored;
    if (entry.is_regular_file(ignored) && std::ranges::count(kForeign, extension_of(entry.path())) > 0)
      names.insert(entry.path().lexically_relative(folder).string());
  });
  if (names.empty()) return "";
  return fmt::format("{} of other formats in {} ({}{}) left out: export as PLY what is to be matched, too",
                     counted(names.size(), "file"), folder.string(), *names.begin(),
                     names.size() == 1 ? "" : ", ...");
}

std::string content_hash(const fs::path& path) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  for (const fs::path& file : mesh::files_of(path)) add_bytes(file, *state);
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hash_if_readable(const fs::path& path) {
  try {
    return content_hash(path);
  } catch (const IoError&) {  // told when it is loaded
    return store::kUnreadable;
  }
}

std::vector<store::Fragment> files_of_equal_size(const Scans& scans) {
  std::map<std::uintmax_t, std::vector<std::string>> of_size;
  for (const auto& [name, file] : scans) {
    std::error_code problem;
    const std::uintmax_t size = fs::file_size(file, problem);
    if (!problem) of_size[size].push_back(name);
  }
  std::vector<store::Fragment> files;
  for (const auto& [size, same_size] : of_size) {
    if (same_size.size() < 2) continue;
    for (const std::string& name : same_size) {
      files.emplace_back();
      files.back().name = name;
      files.back().hash = hash_if_readable(scans.at(name));
    }
  }
  return files;
}

ChangedScans changed_scans(const std::vector<store::Fragment>& fragments) {
  std::vector<std::string> now(fragments.size());
  run_side_by_side(fragments.size(), [&](std::size_t k) {
    if (fragments[k].state == store::FragmentState::Ready) now[k] = hash_if_readable(fragments[k].path);
  });
  ChangedScans scans;
  for (std::size_t k = 0; k < fragments.size(); ++k) {
    if (now[k].empty() || now[k] == fragments[k].hash) continue;
    (now[k] == store::kUnreadable ? scans.gone : scans.changed).push_back(fragments[k].name);
  }
  return scans;
}

std::vector<std::string> told(const ChangedScans& scans, const std::string& instead) {
  std::vector<std::string> lines;
  const auto add = [&](const std::vector<std::string>& names, const std::string& one,
                       const std::string& several, const std::string& mend) {
    if (names.empty()) return;
    lines.push_back(fmt::format("{} {} ({}{}); {} what the run keeps{}", counted(names.size(), "scan"),
                                names.size() == 1 ? one : several, names.front(),
                                names.size() == 1 ? "" : ", ...", instead, mend));
  };
  add(scans.gone, "cannot be read where rejoin batch found it",
      "cannot be read where rejoin batch found them", "");
  add(scans.changed, "changed since rejoin batch matched it", "changed since rejoin batch matched them",
      ": run rejoin batch again");
  return lines;
}

}  // namespace rejoin::batch
