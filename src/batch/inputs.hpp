/// The scans of a folder.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rejoin::batch {

/// Names of all files in the folder (not below it) whose extension is one that mesh::load() knows, sorted by bytes.
/// \throws IoError     the folder cannot be read
/// \throws InputError  it holds fewer than two such files
std::vector<std::string> find_scans(const std::filesystem::path& folder);

/// 128 bits of the file's content (XXH3) as 32 hexadecimal digits; equal contents have equal hashes, under any name.
/// \throws IoError the file cannot be read
std::string content_hash(const std::filesystem::path& path);

/// Files that have the content of another, with the name of the one that stands for both (stands_for_both()).  Only files of equal size are read; one that cannot
/// be read is no copy.
/// \param names  as find_scans() gives them
std::map<std::string, std::string> find_copies(const std::filesystem::path& folder,
                                               const std::vector<std::string>& names);

}  // namespace rejoin::batch
