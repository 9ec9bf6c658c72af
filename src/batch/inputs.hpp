/// The scans of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::batch {

/// Names of all files in the folder (not below it) whose extension is one that mesh::load() knows, sorted by bytes;
/// without the models that `rejoin match` and `assemble` write.
/// \throws IoError     the folder cannot be read
/// \throws InputError  it holds fewer than two such files, or one whose name is no UTF-8
std::vector<std::string> find_scans(const std::filesystem::path& folder);

/// What to tell of the models in the folder that find_scans() leaves out; empty if there are none.
std::string told_of_models(const std::filesystem::path& folder);

/// What to tell of the folders below the folder, however deep, that hold scans, which find_scans() does not look for; empty if there
/// are none.  The surfaces that a run keeps are no scans; of folders below a link nothing is told.
std::string told_of_folders(const std::filesystem::path& folder);

/// 128 bits of the content (XXH3) of mesh::files_of() as 32 hexadecimal digits; equal contents have equal hashes, under any name.
/// \throws IoError a file cannot be read
std::string content_hash(const std::filesystem::path& path);

/// content_hash(), or store::kUnreadable where the file cannot be read.
std::string hash_if_readable(const std::filesystem::path& path);

/// Name and hash_if_readable() of every file whose size another has, too.  No other file can be among store::copies().
/// \param names  as find_scans() gives them
std::vector<store::Fragment> files_of_equal_size(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& names);

/// Scans of a run that are no longer what was matched, by name.
struct ChangedScans {
  std::vector<std::string> gone;     ///< cannot be read where they were
  std::vector<std::string> changed;  ///< have another content
};

/// Reads the files of those that were ready, side by side.
ChangedScans changed_scans(const std::vector<store::Fragment>& fragments);

/// Lines for the user, none if nothing changed.
/// \param instead  what is done with the surfaces that the run keeps, such as "shown"
std::vector<std::string> told(const ChangedScans& scans, const std::string& instead);

}  // namespace rejoin::batch
