/// The scans of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "store/records.hpp"

namespace rejoin::batch {

/// Names of all files in the folder (not below it) whose extension is one that mesh::load() knows, sorted by bytes.
/// \throws IoError     the folder cannot be read
/// \throws InputError  it holds fewer than two such files
std::vector<std::string> find_scans(const std::filesystem::path& folder);

/// 128 bits of the file's content (XXH3) as 32 hexadecimal digits; equal contents have equal hashes, under any name.
/// \throws IoError the file cannot be read
std::string content_hash(const std::filesystem::path& path);

/// content_hash(), or store::kUnreadable where the file cannot be read.
std::string hash_if_readable(const std::filesystem::path& path);

/// Name and hash_if_readable() of every file whose size another has, too.  No other file can be among store::copies().
/// \param names  as find_scans() gives them
std::vector<store::Fragment> files_of_equal_size(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& names);

}  // namespace rejoin::batch
