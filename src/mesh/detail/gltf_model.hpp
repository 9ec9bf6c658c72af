/// glTF files as tinygltf models.  Includes tinygltf: for the glTF reader and writer only.
#pragma once

#include <tiny_gltf.h>

#include "mesh/detail/gltf_textures.hpp"
#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

struct GltfModel {
  tinygltf::Model model;
  GltfTextures textures;
};

/// Reads .gltf or .glb without what a scan does not need (animations, cameras); of materials, what lies on the parts.
/// Primitives with Draco data lose their index accessor, because this tinygltf is built without
/// Draco and refuses accessors without data.
///
/// \throws InputError not glTF, damaged, or requires an extension that cannot be read
/// \throws IoError    truncated, or a buffer file is missing
GltfModel read_gltf_model(const Source& source);

}  // namespace rejoin::mesh::detail
