#include "mesh/detail/gltf_textures.hpp"

#include <nlohmann/json.hpp>

namespace rejoin::mesh::detail {
namespace {

using nlohmann::json;

/// A value within others, by their keys; null if one of them is not there.
const json& inside(const json& value, std::initializer_list<const char*> keys) {
  static const json kNone;
  const json* at = &value;
  for (const char* key : keys) {
    if (!at->is_object() || !at->contains(key)) return kNone;
    at = &(*at)[key];
  }
  return *at;
}

int whole(const json& value, int otherwise) {
  return value.is_number_integer() ? value.get<int>() : otherwise;
}

template <int N>
glm::vec<N, double> vector(const json& value, const glm::vec<N, double>& otherwise) {
  if (!value.is_array() || value.size() < static_cast<std::size_t>(N)) return otherwise;
  glm::vec<N, double> result;
  for (int k = 0; k < N; ++k) {
    if (!value[static_cast<std::size_t>(k)].is_number()) return otherwise;
    result[k] = value[static_cast<std::size_t>(k)].template get<double>();
  }
  return result;
}

/// Entry of a list; null if it has none of that number.
const json& entry(const json& list, int number) {
  static const json kNone;
  if (!list.is_array() || number < 0 || static_cast<std::size_t>(number) >= list.size()) return kNone;
  return list[static_cast<std::size_t>(number)];
}

/// The image of a texture: its own, or that of an extension for other kinds of pictures.
int image_of(const json& texture) {
  for (const char* extension : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif"}) {
    const int other = whole(inside(texture, {"extensions", extension, "source"}), -1);
    if (other >= 0 && whole(inside(texture, {"source"}), -1) < 0) return other;
  }
  return whole(inside(texture, {"source"}), -1);
}

GltfTexture texture_of(const json& material, const json& textures) {
  const json& usual = inside(material, {"pbrMetallicRoughness"});
  const json& older = inside(material, {"extensions", "KHR_materials_pbrSpecularGlossiness"});
  const bool is_usual = inside(usual, {"baseColorTexture"}).is_object();
  const json& info = is_usual ? inside(usual, {"baseColorTexture"}) : inside(older, {"diffuseTexture"});
  const json& change = inside(info, {"extensions", "KHR_texture_transform"});
  GltfTexture texture;
  texture.image = image_of(entry(textures, whole(inside(info, {"index"}), -1)));
  texture.places = whole(inside(change, {"texCoord"}), whole(inside(info, {"texCoord"}), 0));
  texture.offset = vector<2>(inside(change, {"offset"}), texture.offset);
  texture.scale = vector<2>(inside(change, {"scale"}), texture.scale);
  const json& rotation = inside(change, {"rotation"});
  texture.rotation = rotation.is_number() ? rotation.get<double>() : 0.0;
  texture.factor = vector<3>(is_usual ? inside(usual, {"baseColorFactor"}) : inside(older, {"diffuseFactor"}),
                             texture.factor);
  return texture;
}

}  // namespace

GltfTextures gltf_textures(const json& root) {
  GltfTextures result;
  for (const json& image : inside(root, {"images"})) {
    const json& uri = inside(image, {"uri"});
    result.images.push_back(
        {uri.is_string() ? uri.get<std::string>() : "", whole(inside(image, {"bufferView"}), -1)});
  }
  for (const json& material : inside(root, {"materials"}))
    result.of_material.push_back(texture_of(material, inside(root, {"textures"})));
  return result;
}

}  // namespace rejoin::mesh::detail
