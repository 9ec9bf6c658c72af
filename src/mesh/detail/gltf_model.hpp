/// glTF files as tinygltf models.  Includes tinygltf: for the glTF reader and writer only.
#pragma once

#include <tiny_gltf.h>

#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// Reads .gltf or .glb without what a scan's shape does not need (images, materials, animations).
/// Primitives with Draco data lose their index accessor, because this tinygltf is built without
/// Draco and refuses accessors without data.
///
/// \throws InputError not glTF, damaged, or requires an extension that cannot be read
/// \throws IoError    truncated, or a buffer file is missing
tinygltf::Model read_gltf_model(const Source& source);

}  // namespace rejoin::mesh::detail
