#include "cli/fragment.hpp"

#include <fmt/core.h>

#include "cli/interrupt.hpp"
#include "core/error.hpp"
#include "mesh/load.hpp"

namespace rejoin::cli {
namespace {

constexpr std::size_t kLeast = 4;  // faces or points; fewer enclose nothing

mesh::Mesh load_scan(const std::string& path, Console& console) {
  mesh::Loaded loaded = mesh::load(path);
  for (const std::string& warning : loaded.warnings) console.warning(fmt::format("{}: {}", path, warning));
  const bool cloud = loaded.mesh.is_cloud();
  const std::size_t count = cloud ? loaded.mesh.vertices.size() : loaded.mesh.faces.size();
  if (count < kLeast) {
    throw InputError(path, fmt::format("has no more than {} {}", count, cloud ? "points" : "faces"),
                     "give the scan of a whole fragment");
  }
  return std::move(loaded.mesh);
}

match::Fragment read_and_prepare(const std::string& path, Console& console, const Context& context) {
  const NothingToSave guard;
  std::vector<StageTime> stages;
  Stopwatch clock(stages);
  mesh::Mesh scan = load_scan(path, console);
  clock.lap("load");
  match::Fragment fragment = match::prepare(path, std::move(scan), context);
  fragment.stages.insert(fragment.stages.begin(), stages.begin(), stages.end());
  return fragment;
}

}  // namespace

match::Fragment load_fragment(const std::string& path, Console& console, const Context& context) {
  match::Fragment fragment = read_and_prepare(path, console, context);
  double seconds = 0;
  for (const StageTime& stage : fragment.stages) seconds += stage.seconds;
  console.detail(fmt::format("{}: {} points, {} faces, diameter {:.4g}; made ready in {:.2f} s", path,
                             fragment.scan.vertices.size(), fragment.surface.faces.size(), fragment.diameter,
                             seconds));
  return fragment;
}

}  // namespace rejoin::cli
