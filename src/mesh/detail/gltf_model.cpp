#include "mesh/detail/gltf_model.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "core/error.hpp"
#include "core/json_depth.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kGlbHeader = 12;
constexpr std::size_t kChunkHeader = 8;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

void append_word(std::string& bytes, std::uint32_t value) {
  std::array<char, 4> raw;
  std::memcpy(raw.data(), &value, raw.size());
  bytes.append(raw.data(), raw.size());
}

/// The text and the binary chunk of a .glb, or the whole text of a .gltf.
struct Parts {
  std::string_view json;
  std::string_view binary;
  bool is_binary = false;
};

Parts split(const Source& source) {
  const std::string_view bytes = source.bytes;
  if (!bytes.starts_with("glTF")) return {bytes, {}, false};
  if (bytes.size() < kGlbHeader + kChunkHeader)
    throw IoError(source.name, "ends inside its GLB header", "copy or export the file again");
  if (word_at(bytes, 8) > bytes.size()) {
    throw IoError(
        source.name,
        fmt::format("its header promises {} bytes but the file has {}", word_at(bytes, 8), bytes.size()),
        "copy or export the file again");
  }
  Parts parts;
  parts.is_binary = true;
  for (std::size_t at = kGlbHeader; at + kChunkHeader <= bytes.size();) {
    const std::size_t length = word_at(bytes, at);
    const std::uint32_t kind = word_at(bytes, at + 4);
    at += kChunkHeader;
    if (length > bytes.size() - at)
      throw IoError(source.name, fmt::format("ends inside the chunk at byte {}", at),
                    "copy or export the file again");
    if (kind == kJsonChunk && parts.json.empty()) parts.json = bytes.substr(at, length);
    if (kind == kBinaryChunk && parts.binary.empty()) parts.binary = bytes.substr(at, length);
    at += length;
  }
  return parts;
}

bool is_draco(const nlohmann::json& primitive) {
  return primitive.is_object() && primitive.contains("extensions") && primitive["extensions"].is_object() &&
         primitive["extensions"].contains(kDracoExtension);
}

void check_extensions(const nlohmann::json& root, const std::string& name) {
  static const std::set<std::string> kReadable{kDracoExtension, "KHR_mesh_quantization"};
  const auto required = root.find("extensionsRequired");
  if (required == root.end() || !required->is_array()) return;
  for (const nlohmann::json& extension : *required) {
    const std::string text = extension.is_string() ? extension.get<std::string>() : "?";
    // A scan's shape does not depend on materials and pictures, whatever extends them.
    if (kReadable.count(text) > 0 || text.starts_with("KHR_materials_") ||
        text.find("_texture_") != std::string::npos)
      continue;
    throw InputError(name, "requires the glTF extension " + text, "export it without that extension");
  }
}

/// The text with only what tinygltf has to read.
/// \param textures  gets what lies on the parts
std::string reduced(std::string_view text, const std::string& name, GltfTextures& textures) {
  // Not by the parser's callback, for which it looks at all of a list again for each of the entries.
  if (json_depth(text) > kDeepestJson)
    throw InputError(name, fmt::format("glTF JSON is nested deeper than {}", kDeepestJson),
                     "export it again");
  nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (root.is_discarded() || !root.is_object())
    throw InputError(name, "is not a glTF file (its JSON cannot be read)", "check the file's format");
  check_extensions(root, name);
  textures = gltf_textures(root);
  for (const char* unneeded :
       {"images", "textures", "samplers", "materials", "animations", "skins", "cameras", "extensions"}) {
    root.erase(unneeded);
  }
  if (root.contains("meshes") && root["meshes"].is_array()) {
    for (nlohmann::json& mesh : root["meshes"]) {
      if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
      for (nlohmann::json& primitive : mesh["primitives"]) {
        if (is_draco(primitive)) primitive.erase("indices");
      }
    }
  }
  return root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A .glb of the given parts.
std::string join(std::string json, std::string_view binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string padded(binary);
  padded.resize((padded.size() + 3) / 4 * 4, '\0');
  std::string glb = "glTF";
  append_word(glb, 2);
  const std::size_t total =
      kGlbHeader + kChunkHeader + json.size() + (padded.empty() ? 0 : kChunkHeader + padded.size());
  append_word(glb, static_cast<std::uint32_t>(total));
  append_word(glb, static_cast<std::uint32_t>(json.size()));
  append_word(glb, kJsonChunk);
  glb += json;
  if (padded.empty()) return glb;
  append_word(glb, static_cast<std::uint32_t>(padded.size()));
  append_word(glb, kBinaryChunk);
  return glb += padded;
}

// tinygltf opens files to see whether they are there, and would wait for pipes.
bool is_there(const std::string& path, void* /*unused*/) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

bool read_buffer(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                 void* unused) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored))
    return tinygltf::ReadWholeFile(bytes, error, path, unused);
  *error = "is a folder, pipe or device";
  return false;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

GltfModel read_gltf_model(const Source& source) {
  if (source.bytes.size() > std::numeric_limits<std::uint32_t>::max() / 2) {
    throw InputError(source.name, "is larger than 2 GB", "save it as PLY");
  }
  const Parts parts = split(source);
  GltfModel result;
  const std::string json = reduced(parts.json, source.name, result.textures);
  const std::string folder = source.path.parent_path().string();
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks(
      {&is_there, &tinygltf::ExpandFilePath, &read_buffer, &tinygltf::WriteWholeFile, nullptr});
  tinygltf::Model& model = result.model;
  std::string error;
  std::string warning;
  bool good = false;
  try {
    if (parts.is_binary) {
      const std::string glb = join(json, parts.binary);
      good = reader.LoadBinaryFromMemory(&model, &error, &warning,
                                         reinterpret_cast<const unsigned char*>(glb.data()),
                                         static_cast<unsigned>(glb.size()), folder);
    } else {
      good = reader.LoadASCIIFromString(&model, &error, &warning, json.data(),
                                        static_cast<unsigned>(json.size()), folder);
    }
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  if (good) return result;
  if (error.find("File not found") != std::string::npos ||
      error.find("File read error") != std::string::npos) {
    throw IoError(source.name, "a buffer file that it names cannot be read (" + first_line(error) + ")",
                  "keep the .bin files beside it");
  }
  throw InputError(source.name, "is not a valid glTF file (" + first_line(error) + ")", "export it again");
}

}  // namespace rejoin::mesh::detail
