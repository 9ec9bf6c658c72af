#include "cli/fragment.hpp"

#include <fmt/core.h>

#include <chrono>

#include "cli/interrupt.hpp"
#include "core/error.hpp"
#include "mesh/load.hpp"

namespace rejoin::cli {
namespace {

constexpr std::size_t kLeastFaces = 4;  // fewer enclose nothing

}  // namespace

match::Fragment load_fragment(const std::string& path, Console& console, const Context& context) {
  const NothingToSave guard;
  const auto begin = std::chrono::steady_clock::now();
  mesh::Loaded loaded = mesh::load(path);
  for (const std::string& warning : loaded.warnings) console.warning(path + ": " + warning);
  const auto middle = std::chrono::steady_clock::now();
  match::Fragment fragment = match::prepare(path, std::move(loaded.mesh), context);
  if (fragment.surface.faces.size() < kLeastFaces) {
    throw InputError(path, fmt::format("has a surface of only {} faces", fragment.surface.faces.size()),
                     "give the scan of a whole fragment");
  }
  const auto end = std::chrono::steady_clock::now();
  console.detail(
      fmt::format("{}: {} points, {} faces, diameter {:.4g}; read in {:.2f} s, made ready in {:.2f} s", path,
                  fragment.scan.vertices.size(), fragment.surface.faces.size(), fragment.diameter,
                  std::chrono::duration<double>(middle - begin).count(),
                  std::chrono::duration<double>(end - middle).count()));
  return fragment;
}

}  // namespace rejoin::cli
