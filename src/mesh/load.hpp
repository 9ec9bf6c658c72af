/// Reading of scans: PLY, OBJ, STL, OFF, glTF/GLB, Draco.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// What was read, after clean-up, and what had to be mended on the way.
struct Loaded {
  Mesh mesh;
  std::string format;                 ///< "ply", "obj", ...
  std::vector<std::string> warnings;  ///< one line each: points without normals, faces dropped, ...
};

/// Reads a mesh or an oriented cloud by its extension (any case) and cleans it: equal vertices welded,
/// degenerate and duplicate faces dropped, unused vertices of a mesh dropped, cloud normals made unit length
/// (estimated and oriented outwards, with a warning, where the file has none). \throws IoError     the file
/// cannot be opened or is shorter than its header promises \throws InputError  unknown extension, not such a
/// file, NaN or infinite coordinate (names its vertex), index out of
///                     range (names its face), nothing left after clean-up, no area
Loaded load(const std::filesystem::path& path);

}  // namespace rejoin::mesh
