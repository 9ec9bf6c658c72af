#include "batch/painted.hpp"

#include <fmt/format.h>

#include <system_error>

#include "batch/inputs.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "match/paint.hpp"
#include "mesh/load.hpp"

namespace rejoin::batch {
namespace fs = std::filesystem;
namespace {

constexpr const char* kEnd = "-facets";
constexpr const char* kNaming = "the painted surface of a.ply is a-facets.ply";

fs::path kept_file(const std::string& hash, const fs::path& cache) {
  return cache / (hash + kEnd + ".ply");
}

/// Names of files that end in "-facets" and an ending of meshes.
std::vector<std::string> painted_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code problem;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    const fs::path& path = entry->path();
    if (mesh::has_scan_name(path) && path.stem().string().ends_with(kEnd) &&
        !path.filename().string().starts_with('.'))
      names.push_back(path.filename().string());
  }
  if (problem) {
    throw IoError(folder.string(), fmt::format("cannot be read ({})", problem.message()),
                  "give the folder of the painted surfaces");
  }
  return names;
}

}  // namespace

std::string painted_name(const std::string& scan) {
  const fs::path name(scan);  // of a file, or of a folder, in whose name a dot ends nothing
  return (mesh::has_scan_name(name) ? name.stem() : name).string() + kEnd + ".ply";
}

FoundPainted find_painted(const fs::path& folder, const std::vector<std::string>& scans) {
  std::map<std::string, std::vector<std::string>> scans_of;
  for (const std::string& name : painted_files(folder)) scans_of[name] = {};
  if (scans_of.empty()) throw InputError(folder.string(), "holds no painted surface", kNaming);
  FoundPainted found;
  for (const std::string& scan : scans) {
    const auto file = scans_of.find(painted_name(scan));
    if (file == scans_of.end()) continue;
    file->second.push_back(scan);
    found.painted[scan] = folder / file->first;
  }
  if (found.painted.empty())
    throw InputError(folder.string(), "holds no painted surface of a scan of the folder", kNaming);
  for (const auto& [name, of] : scans_of) {
    const std::string file = (folder / name).string();
    if (of.size() > 1) {
      found.warnings.push_back(
          fmt::format("{}: is used for {}; where it does not lie on one of them, give that scan another name",
                      file, fmt::join(of, " and ")));
    } else if (of.empty() && extension_of(name) == ".ply") {
      found.warnings.push_back(fmt::format("{}: left out, belongs to no scan of the folder", file));
    } else if (of.empty()) {
      found.warnings.push_back(fmt::format("{}: left out, is no PLY", file));
    }
  }
  return found;
}

std::string keep_painted(const fs::path& file, const fs::path& cache) {
  std::string hash = content_hash(file);
  const fs::path kept = kept_file(hash, cache);
  if (hash_if_readable(kept) == hash) return hash;
  const std::string content = read_file(file);
  try {
    write_file(kept, content);
  } catch (const IoError& error) {
    throw StoreError(kept.string(), "a painted surface cannot be kept",
                     fmt::format("free some space and run the command again ({})", error.what()));
  }
  return hash;
}

void use_kept_paint(match::Fragment& prepared, const store::Fragment& record, const fs::path& cache) {
  const std::string name = painted_name(record.name);
  const fs::path kept = kept_file(record.facets, cache);
  std::error_code ignored;
  if (!fs::is_regular_file(kept, ignored))
    throw InputError(name, "is kept in the run no longer", "run rejoin batch again");
  mesh::Mesh painted;
  try {
    painted = mesh::load(kept, mesh::Weld::PlacesAndColours).mesh;
  } catch (const Error& error) {
    throw InputError(name, fmt::format("cannot be used ({})", error.what()), "save it again");
  }
  const auto told = match::paint(prepared, name, painted);
  if (!told) {
    throw InputError(name, fmt::format("does not lie on {}", record.name),
                     "paint the file that rejoin facets writes of it, and do not move it");
  }
  prepared.warnings.insert(prepared.warnings.end(), told->begin(), told->end());
}

}  // namespace rejoin::batch
