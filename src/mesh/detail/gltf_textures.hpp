/// Which pictures lie on the parts of a glTF file.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace rejoin::mesh::detail {

/// A picture inside of the file or beside it.
struct GltfImage {
  std::string uri;
  int view = -1;  ///< number of the bufferView, where there is no uri
};

/// The picture that a material lays on a part.
struct GltfTexture {
  int image = -1;          ///< -1: none
  int places = 0;          ///< number of the TEXCOORD that tells where its points lie
  glm::dvec2 offset{0.0};  ///< places times scale and offset are those on the picture
  glm::dvec2 scale{1.0};
  double rotation = 0.0;   ///< of the places, radians
  glm::dvec3 factor{1.0};  ///< of the colours, linear
};

struct GltfTextures {
  std::vector<GltfImage> images;
  std::vector<GltfTexture> of_material;
};

/// Base colours of the materials.  What is not as glTF has it is left out: a scan's shape does not depend on it.
/// \param root  the file's JSON
GltfTextures gltf_textures(const nlohmann::json& root);

}  // namespace rejoin::mesh::detail
