#include "cli/fragment.hpp"

#include <fmt/core.h>

#include <chrono>

#include "cli/interrupt.hpp"
#include "core/error.hpp"
#include "mesh/load.hpp"

namespace rejoin::cli {
namespace {

constexpr std::size_t kLeast = 4;  // faces or points; fewer enclose nothing

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

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
  return match::prepare(path, load_scan(path, console), context);
}

}  // namespace

match::Fragment load_fragment(const std::string& path, Console& console, const Context& context) {
  const auto begin = std::chrono::steady_clock::now();
  match::Fragment fragment = read_and_prepare(path, console, context);
  console.detail(fmt::format("{}: {} points, {} faces, diameter {:.4g}; made ready in {:.2f} s", path,
                             fragment.scan.vertices.size(), fragment.surface.faces.size(), fragment.diameter,
                             seconds_since(begin)));
  return fragment;
}

}  // namespace rejoin::cli
