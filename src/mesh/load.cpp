#include "mesh/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "mesh/detail/soup.hpp"

namespace rejoin::mesh {
namespace {

using Reader = detail::Soup (*)(const detail::Source&);

struct Format {
  const char* extension;
  const char* name;
  Reader read;
};

constexpr std::array kFormats{
    Format{".ply", "ply", detail::read_ply},  Format{".obj", "obj", detail::read_obj},
    Format{".stl", "stl", detail::read_stl},  Format{".off", "off", detail::read_off},
    Format{".glb", "glb", detail::read_gltf}, Format{".gltf", "gltf", detail::read_gltf},
    Format{".drc", "drc", detail::read_drc},
};

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
  }
  throw InputError(path.string(),
                   extension.empty() ? "has no file name extension" : "unknown extension " + extension,
                   "use one of .ply .obj .stl .off .glb .gltf .drc");
}

}  // namespace

namespace detail {

Source read_source(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw IoError(path.string(), "is a folder", "name a mesh file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw IoError(path.string(), fmt::format("cannot be opened ({})", std::strerror(errno)),
                  "check the path and its permissions");
  }
  Source source{path.string(), path, {}};
  stream.seekg(0, std::ios::end);
  if (const std::streamoff size = stream.tellg(); size >= 0) {
    source.bytes.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(source.bytes.data(), size);
  } else {  // a pipe has no size
    stream.clear();
    std::ostringstream all;
    if (stream.peek() != std::ifstream::traits_type::eof()) all << stream.rdbuf();
    source.bytes = std::move(all).str();
  }
  if (stream.bad() || (stream.fail() && !source.bytes.empty())) {
    throw IoError(source.name, "cannot be read", "check the disk or copy the file again");
  }
  if (source.bytes.empty())
    throw InputError(source.name, "is empty (0 bytes)", "export or copy the scan again");
  return source;
}

}  // namespace detail

Loaded load(const std::filesystem::path& path, Weld weld) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw IoError(path.string(), "is a folder", "name a mesh file");
  const Format& format = format_of(path);
  const detail::Source source = detail::read_source(path);
  Loaded loaded = detail::clean(format.read(source), source.name, weld);
  loaded.format = format.name;
  return loaded;
}

}  // namespace rejoin::mesh
