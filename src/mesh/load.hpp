/// Reading of scans: PLY, OBJ, STL, OFF, glTF/GLB, Draco, XYZ/PTS.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// What was read, after clean-up, and what had to be mended on the way.
struct Loaded {
  Mesh mesh;
  std::string format;  ///< "ply", "obj", ...
  std::vector<std::string>
      warnings;  ///< one line each, which names the file: points without normals, faces dropped, ...
};

/// Which vertices become one.
enum class Weld {
  Places,            ///< those at exactly the same place
  PlacesAndColours,  ///< of the same colour, too: borders of painted patches stay sharp, at the price of open edges
};

/// What a file is to be taken for.
enum class Content {
  OnePiece,
  Whole,    ///< an object that is not broken yet: cavities stay
  Several,  ///< pieces and what they lie on: small parts, strays and the normals of a cloud are left as they are (there may be none)
};

/// Whether a file's name ends as those do that load() reads.
bool has_scan_name(const std::filesystem::path& path);

/// Reads a mesh or an oriented cloud by its extension (any case) and cleans it.
///
/// Points that are not finite are left out, with the faces that use them.  Equal vertices are welded (exactly equal ones: nothing depends on the scale), degenerate and duplicate faces dropped, specks
/// far from the rest dropped (each less than 1 % of the area, farther away than a tenth of the size of the rest, or dust that floats beside it), lone vertices farther from the rest than four
/// times its size, stray points of a cloud, closed surfaces inside the piece (cavities of a CT scan) and vertices of no face dropped, faces wound against their neighbours or a surface that is inside out turned, cloud
/// normals made unit length, estimated where the file has none, and turned outwards.  Whatever changes the surface is said in a
/// warning.  Non-manifold and open meshes load whole.
///
/// \throws IoError     the file cannot be opened or ends before what its header promises
/// \throws InputError  unknown extension, empty or not such a file, more than a tenth of the faces, or half of the points of a
///                     cloud, at NaN or infinite coordinates (names a vertex), index out of range (names its face), nothing or less
///                     than half left after clean-up, next to no area, not between 1e-6 and 1e9 across, floats too far from the
///                     origin
Loaded load(const std::filesystem::path& path, Weld weld = Weld::Places, Content content = Content::OnePiece);

}  // namespace rejoin::mesh
