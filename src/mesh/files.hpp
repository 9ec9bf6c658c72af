/// Files of a scan.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rejoin::mesh {

/// The file itself, and those that it takes its geometry from: the buffers of a .gltf, in its order.  They need not be there.
/// What is no glTF in truth has itself alone; load() says what is wrong with it.
/// \throws IoError a .gltf cannot be read
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path);

/// "%20" and the like in the name of a file as the bytes that they stand for.
std::string percent_decoded(const std::string& uri);

}  // namespace rejoin::mesh
