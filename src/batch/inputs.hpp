/// The scans of a folder.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::batch {

/// The files of scans, by the names that their fragments go by.
using Scans = std::map<std::string, std::filesystem::path>;

/// All files in the folder whose extension is one that mesh::load() knows, without the models that `rejoin match` and `assemble`
/// write, and without painted_name() of the others.  Where it holds none, but folders with one scan each, however deep, as apps leave them: these scans by the folders' names.
/// Left out are untellable_scans(), too.
/// \throws IoError     the folder cannot be read
/// \throws InputError  it holds fewer than two scans, or folders of which one holds several
Scans find_scans(const std::filesystem::path& folder);

/// Scans with names that require_tellable_name() refuses, with its reason as their error; bad fragments of no database.
/// \throws as find_scans()
std::vector<store::Fragment> untellable_scans(const std::filesystem::path& folder);

/// Sorted by bytes.
std::vector<std::string> names_of(const Scans& scans);

/// What to tell of the models in the folder that find_scans() leaves out; empty if there are none.
std::string told_of_models(const std::filesystem::path& folder);

/// What to tell of painted surfaces of scans that lie beside them, which find_scans() leaves out; empty if there are none.
std::string told_of_painted(const std::filesystem::path& folder);

/// What to tell of the folders below a folder of scans, however deep, that hold scans, which find_scans() leaves out; empty if there
/// are none.  The surfaces that a run keeps are no scans; of folders below a link nothing is told.
std::string told_of_folders(const std::filesystem::path& folder);

/// What to tell of scans in the folder, and below it, of formats that mesh::load() does not know; empty if there are none.
std::string told_of_formats(const std::filesystem::path& folder);

/// 128 bits of the content (XXH3) of mesh::files_of() as 32 hexadecimal digits; equal contents have equal hashes, under any name.
/// \throws IoError a file cannot be read
std::string content_hash(const std::filesystem::path& path);

/// content_hash(), or store::kUnreadable where the file cannot be read.
std::string hash_if_readable(const std::filesystem::path& path);

/// Name and hash_if_readable() of every scan whose file's size another's has, too.  No other can be among store::copies().
std::vector<store::Fragment> files_of_equal_size(const Scans& scans);

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
