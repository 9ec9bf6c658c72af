/// Painted facets of the scans of a folder.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "match/match.hpp"
#include "store/records.hpp"

namespace rejoin::batch {

/// Files of painted surfaces by the names of their scans.
using Painted = std::map<std::string, std::filesystem::path>;

/// The painted surface of a scan in its folder: "a-facets.ply" of a.obj.
std::string painted_name(const std::string& scan);

struct FoundPainted {
  Painted painted;
  std::vector<std::string> warnings;  ///< of files that belong to no scan, or to several, or are no PLY
};

/// Looks for painted_name() of the scans in a folder; other files are left alone.  One that belongs to several scans is of each: where it
/// does not lie on the scan, use_kept_paint() refuses it.
/// \param scans  names
/// \throws IoError     the folder cannot be read
/// \throws InputError  it holds none of the scans
FoundPainted find_painted(const std::filesystem::path& folder, const std::vector<std::string>& scans);

/// Keeps a copy under `cache`, named after its content, for who looks at the run later.
/// \return hash of the content, for store::Fragment::facets
/// \throws IoError it cannot be read   \throws StoreError the copy cannot be written
std::string keep_painted(const std::filesystem::path& file, const std::filesystem::path& cache);

/// Gives the prepared fragment the facets that are kept of it; its warnings get what is to be told.
/// \param record  with facets
/// \throws InputError they cannot be used, or are kept no longer
void use_kept_paint(match::Fragment& prepared, const store::Fragment& record,
                    const std::filesystem::path& cache);

}  // namespace rejoin::batch
