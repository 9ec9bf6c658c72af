/// Prepared fragments, in memory and on disk.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/inputs.hpp"
#include "core/context.hpp"
#include "match/match.hpp"
#include "store/records.hpp"

namespace rejoin::batch {

/// The folder of a run that keeps the surfaces of its scans.
inline constexpr const char* kCacheName = "fragments";

/// Loads the fragment's surface for matching: the one kept under `cache` if there is one, else from its scan, whose surface is then
/// kept (Draco, named after the content's hash and the matcher's; those of other builds go, but stand for a scan that is gone).  What is matched is always the kept surface, so that the first run and later ones give
/// the same bytes.  Facets are as the user painted them, where that is kept.
/// \param cache  folder, made if it is not there
/// \throws InputError, IoError the scan cannot be used, or is no longer of the fragment's hash   \throws StoreError the cache cannot be written
match::Fragment load_prepared(const store::Fragment& fragment, const std::filesystem::path& cache,
                              mesh::PieceKind kind, const Context& context);

/// The surface kept under `cache`, if it is there and whole.
std::optional<mesh::Mesh> kept_surface(const store::Fragment& fragment, const std::filesystem::path& cache);

/// Of scans that changed, those whose surfaces are kept under `cache`: of the others nothing stands for what was matched.
/// \param fragments  of the run
ChangedScans kept_ones(const ChangedScans& scans, const std::vector<store::Fragment>& fragments,
                       const std::filesystem::path& cache);

/// Puts the surfaces that several runs keep into one cache, as links to the same files where the disk can.
/// \throws StoreError the cache cannot be written
void gather_surfaces(const std::vector<std::filesystem::path>& caches, const std::filesystem::path& cache);

/// The prepared fragments that the pairs in hand need.
class Shelf {
 public:
  /// What became of a fragment (faces, lengths, state and error are filled in), and what was mended in its file where that was read.
  /// Called from one thread at a time.
  using Told = std::function<void(const store::Fragment&, const std::vector<std::string>& warnings)>;

  Shelf(std::filesystem::path cache, mesh::PieceKind kind) : cache_(std::move(cache)), kind_(kind) {}

  /// Puts these fragments on the shelf, side by side, and takes all others off.  One that is marked bad, or turns out so, is left out.
  /// After a cancel some may be missing.
  /// \throws StoreError the cache cannot be written
  void hold(const std::vector<store::Fragment>& wanted, const Context& context, const Told& told);

  /// nullptr if it is not on the shelf.
  const match::Fragment* find(const std::string& name) const;

 private:
  std::filesystem::path cache_;
  mesh::PieceKind kind_;
  std::map<std::string, std::unique_ptr<const match::Fragment>> held_;
};

}  // namespace rejoin::batch
