/// The file of --layout.
#pragma once

#include <string>
#include <vector>

#include "batch/batch.hpp"
#include "batch/inputs.hpp"

namespace rejoin::cli {

struct LaidScans {
  batch::Layout layout;
  std::vector<std::string> warnings;  ///< what was left out
};

/// Reads where the user laid scans by hand: a MeshLab project (of its layers those that are not hidden; which scan each is, its file's
/// name tells), an assembly.json of rejoin assemble (of its first, largest
/// object, as nothing is known of how objects lie to each other), or JSON as read_constraints() takes it (of its "poses").
/// Of scans that are no longer what the assembly was made of (its "scan"), the old places are left out and told.
/// \param scans  of the folder
/// \throws IoError it cannot be read
/// \throws InputError it is no such file, names a scan that is not there or one twice, has a pose that is no proper rigid motion, or
///         lays fewer than two scans
LaidScans read_layout(const std::string& path, const batch::Scans& scans);

}  // namespace rejoin::cli
