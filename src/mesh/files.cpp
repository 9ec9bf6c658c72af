#include "mesh/files.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files.hpp"
#include "core/json_depth.hpp"

namespace rejoin::mesh {

std::string percent_decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      text += static_cast<char>(byte);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files{path};
  if (extension_of(path) != ".gltf") return files;
  const std::string text = read_file(path);
  if (json_depth(text) > kDeepestJson) return files;
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object() || !root.contains("buffers") || !root["buffers"].is_array()) return files;
  for (const nlohmann::json& buffer : root["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const std::string uri = buffer["uri"].get<std::string>();
    if (!uri.starts_with("data:")) files.push_back(path.parent_path() / percent_decoded(uri));
  }
  return files;
}

}  // namespace rejoin::mesh
