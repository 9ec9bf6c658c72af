/// Writing of meshes: PLY (binary little-endian), OBJ, GLB, Draco.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Names of the scenes that `rejoin match` and `rejoin assemble` write.  They may lie among scans, and are none.
inline constexpr const char* kJoinedGlb = "joined.glb";
inline constexpr const char* kJoinedPly = "joined.ply";
inline constexpr const char* kAssembledGlb = "assembled.glb";
inline constexpr const char* kAssembledPly = "assembled.ply";
inline constexpr std::array kSceneNames{kAssembledGlb, kAssembledPly, kJoinedGlb, kJoinedPly};

inline constexpr double kFarFromOrigin = 1000.0;  ///< diameters of the first mesh of a scene

/// A mesh at a pose in a scene file.
struct Placed {
  std::string name;
  const Mesh* mesh;  ///< not owned, not null
  Rigid pose;        ///< file coordinates -> common frame
};

/// Writes one mesh in its file coordinates; the extension (.ply, .obj, .glb, .drc) chooses the
/// format.  The file appears whole or not at all (written beside and renamed).
///
/// \throws InputError unknown extension
/// \throws IoError the file cannot be written
void save(const std::filesystem::path& path, const Mesh& mesh);

/// What save() to a .drc and load() would give back: `rejoin batch` keeps its scans so.
/// \param name  for messages
/// \throws InputError  next to nothing is left at a millionth of its size
/// \throws IoError     the encoder failed
Mesh as_kept(const Mesh& mesh, const std::string& name);

/// Writes several placed meshes: .glb gives one named node a mesh, with its transform; .ply and .obj give one
/// merged mesh.  In a .glb, the first mesh's origin comes to zero if it is farther from it than kFarFromOrigin.
void save_scene(const std::filesystem::path& path, const std::vector<Placed>& parts);

}  // namespace rejoin::mesh
