#include "mesh/detail/obj_materials.hpp"

#include <algorithm>
#include <system_error>

#include "mesh/detail/text.hpp"

namespace rejoin::mesh::detail {
namespace fs = std::filesystem;
namespace {

/// A file that another names, which may have been made on another machine: with its folders, or else by its name alone.
fs::path beside(const fs::path& folder, std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '\\', '/');
  std::error_code ignored;
  const fs::path whole = folder / text;
  return fs::is_regular_file(whole, ignored) ? whole : folder / fs::path(text).filename();
}

/// What stands behind the options of a map, such as "-s 1 1 1".
std::string_view without_options(std::string_view text) {
  const auto is_value = [](std::string_view word) {
    return to_number(word).has_value() || word == "on" || word == "off";
  };
  while (text.starts_with('-')) {
    for (bool first = true; first || is_value(text.substr(0, text.find_first_of(" \t"))); first = false) {
      text.remove_prefix(std::min(text.find_first_of(" \t"), text.size()));
      text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
      if (text.empty()) return text;
    }
  }
  return text;
}

}  // namespace

std::optional<std::map<std::string, fs::path>> textures_of_materials(const fs::path& folder,
                                                                     std::string_view name) {
  const fs::path path = beside(folder, name);
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  std::map<std::string, fs::path> textures;
  if (fs::file_size(path, ignored) == 0) return textures;
  const Source source = read_source(path);
  TextLines lines(source);
  std::string material;
  while (lines.next_line()) {
    const std::string_view keyword = lines.next_word();
    if (keyword == "newmtl") {
      material = lines.rest();
    } else if (keyword == "map_Kd") {
      const std::string_view picture = without_options(lines.rest());
      if (!picture.empty()) textures[material] = beside(folder, picture);
    }
  }
  return textures;
}

}  // namespace rejoin::mesh::detail
