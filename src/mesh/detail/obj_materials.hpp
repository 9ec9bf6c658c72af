/// Textures of OBJ files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace rejoin::mesh::detail {

/// Reads the materials (.mtl) that an OBJ file names.
/// \param folder  of the OBJ file   \param name  what stands behind "mtllib"
/// \return the picture of each material that has one (map_Kd), by the material's name; the file need not be there.  nullopt: there
/// is no such file of materials.
/// \throws IoError it cannot be read
std::optional<std::map<std::string, std::filesystem::path>> textures_of_materials(
    const std::filesystem::path& folder, std::string_view name);

}  // namespace rejoin::mesh::detail
