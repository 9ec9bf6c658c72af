#include "mesh/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "core/files.hpp"
#include "mesh/detail/soup.hpp"
#include "picture/image_file.hpp"

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
    Format{".drc", "drc", detail::read_drc},  Format{".xyz", "xyz", detail::read_xyz},
    Format{".pts", "pts", detail::read_xyz},
};

/// Whether `rejoin outline` reads such files.
bool is_flat(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return picture::has_picture_name(path) || extension == ".svg" || extension == ".csv" ||
         extension == ".geojson";
}

const Format* find_format(const std::string& extension) {
  const auto* found = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& format) { return extension == format.extension; });
  return found == kFormats.end() ? nullptr : found;
}

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (const Format* format = find_format(extension)) return *format;
  if (is_flat(path))
    throw InputError(path.string(), "is a picture or an outline",
                     "scans of solid pieces are meshes or clouds; flat pieces are matched by rejoin outline");
  throw InputError(path.string(),
                   extension.empty() ? "has no file name extension" : "unknown extension " + extension,
                   "use one of .ply .obj .stl .off .glb .gltf .drc .xyz .pts");
}

/// What a file's first bytes say that it is.
struct Signature {
  std::string_view bytes;
  const char* what;
  Reader read;  ///< nullptr: nothing reads it
  const char* mend;
};

constexpr const char* kExport = "export the scan as .ply, .obj, .stl, .off or .glb";
constexpr std::array kSignatures{
    Signature{"ply\n", "a PLY file", detail::read_ply, "name it .ply"},
    Signature{"ply\r", "a PLY file", detail::read_ply, "name it .ply"},
    Signature{"glTF", "a GLB file", detail::read_gltf, "name it .glb"},
    Signature{"DRACO", "a Draco file", detail::read_drc, "name it .drc"},
    Signature{"OFF\n", "an OFF file", detail::read_off, "name it .off"},
    Signature{"\x89PNG", "a PNG picture", nullptr, kExport},
    Signature{"\xff\xd8\xff", "a JPEG picture", nullptr, kExport},
    Signature{"PK\x03\x04", "a ZIP archive", nullptr, "unpack it"},
    Signature{"\x1f\x8b", "a gzip archive", nullptr, "unpack it"},
    Signature{"%PDF", "a PDF document", nullptr, kExport},
    Signature{"<!DOCTYPE", "a web page", nullptr, "download the scan itself"},
    Signature{"<html", "a web page", nullptr, "download the scan itself"},
};

/// Refuses a file that is known to be something else than its name says.
void require_format(const detail::Source& source, const Format& format) {
  for (const Signature& signature : kSignatures) {
    if (source.bytes.rfind(signature.bytes, 0) != 0 || format.read == signature.read) continue;
    throw InputError(source.name, fmt::format("holds {}, not what its name says", signature.what),
                     signature.mend);
  }
}

}  // namespace

namespace detail {

Source read_source(const std::filesystem::path& path) {
  Source source{path.string(), path, read_file(path)};
  if (source.bytes.empty())
    throw InputError(source.name, "is empty (0 bytes)", "export or copy the scan again");
  return source;
}

}  // namespace detail

bool has_scan_name(const std::filesystem::path& path) {
  return find_format(extension_of(path)) != nullptr;
}

Loaded load(const std::filesystem::path& path, Weld weld, Content content) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw IoError(path.string(), "is a folder", "name a mesh file");
  const Format& format = format_of(path);
  const detail::Source source = detail::read_source(path);
  require_format(source, format);
  Loaded loaded = detail::clean(format.read(source), source.name, weld, content);
  loaded.format = format.name;
  return loaded;
}

}  // namespace rejoin::mesh
