/// The file of --layout.
#pragma once

#include <string>
#include <vector>

#include "batch/batch.hpp"

namespace rejoin::cli {

/// Reads where the user laid scans by hand: a MeshLab project (of its layers those that are not hidden; which scan each is, its file's
/// name tells), an assembly.json of rejoin assemble (of its first, largest
/// object, as nothing is known of how objects lie to each other), or JSON as read_constraints() takes it (of its "poses").
/// \param names  of the scans in the folder
/// \throws IoError it cannot be read
/// \throws InputError it is no such file, names a scan that is not there or one twice, has a pose that is no proper rigid motion, or
///         lays fewer than two scans
batch::Layout read_layout(const std::string& path, const std::vector<std::string>& names);

}  // namespace rejoin::cli
