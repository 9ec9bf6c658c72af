#include "cli/fragment.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <map>
#include <system_error>

#include "cli/interrupt.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "match/paint.hpp"
#include "mesh/load.hpp"

namespace rejoin::cli {
namespace {

constexpr std::size_t kLeast = 4;  // faces or points; fewer enclose nothing

mesh::Loaded load_scan(const std::string& path, Console& console, mesh::Weld weld = mesh::Weld::Places) {
  require_no_folder(path, "name a scan in it; rejoin batch takes the folder");
  require_tellable_name(path);
  mesh::Loaded loaded = mesh::load(path, weld);
  for (const std::string& warning : loaded.warnings) console.warning(warning);
  const bool cloud = loaded.mesh.is_cloud();
  const std::size_t count = cloud ? loaded.mesh.vertices.size() : loaded.mesh.faces.size();
  if (count < kLeast) {
    throw InputError(path, fmt::format("has no more than {} {}", count, cloud ? "points" : "faces"),
                     "give the scan of a whole fragment");
  }
  return loaded;
}

match::Fragment read_and_prepare(const std::string& path, Console& console, const Context& context,
                                 mesh::PieceKind kind) {
  const NothingToSave guard;
  std::vector<StageTime> stages;
  Stopwatch clock(stages);
  mesh::Loaded scan = load_scan(path, console);
  clock.lap("load");
  match::Fragment fragment = match::prepare_as_kept(path, std::move(scan.mesh), context, kind);
  for (const std::string& warning : fragment.warnings) console.warning(warning);
  fragment.warnings.insert(fragment.warnings.begin(), scan.warnings.begin(), scan.warnings.end());
  fragment.stages.insert(fragment.stages.begin(), stages.begin(), stages.end());
  return fragment;
}

}  // namespace

void require_no_folder(const std::string& path, const std::string& mend) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw IoError(path, "is a folder", mend);
}

void add_solid(CLI::App& app, bool& solid) {
  app.add_flag("--solid", solid, "no sherds with walls: any surface may be broken")->group("Input");
}

match::Fragment load_fragment(const std::string& path, Console& console, const Context& context,
                              mesh::PieceKind kind) {
  match::Fragment fragment = read_and_prepare(path, console, context, kind);
  double seconds = 0;
  for (const StageTime& stage : fragment.stages) seconds += stage.seconds;
  console.detail(fmt::format("{}: {} points, {} faces, diameter {:.4g}; made ready in {:.2f} s", path,
                             fragment.surface.vertices.size(), fragment.surface.faces.size(),
                             fragment.diameter, seconds));
  return fragment;
}

void use_painted_facets(const std::vector<std::string>& files, const std::vector<match::Fragment*>& fragments,
                        Console& console) {
  std::map<const match::Fragment*, std::string> painted_by;
  for (const std::string& file : files) {
    const mesh::Mesh painted = load_scan(file, console, mesh::Weld::PlacesAndColours).mesh;
    bool used = false;
    for (match::Fragment* fragment : fragments) {
      const auto told = match::paint(*fragment, file, painted);
      if (!told) continue;
      const auto [earlier, first] = painted_by.emplace(fragment, file);
      if (!first) {
        throw InputError(file, "lies on the same scan as " + earlier->second, "give one painted file a scan");
      }
      for (const std::string& warning : *told) console.warning(warning);
      used = true;
    }
    if (!used) {
      throw InputError(file, "lies on none of the scans",
                       "paint the file that rejoin facets SCAN --ply writes, and do not move it");
    }
  }
}

}  // namespace rejoin::cli
