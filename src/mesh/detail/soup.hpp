/// What a file holds before clean-up, and the checks that all readers share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/load.hpp"

namespace rejoin::mesh::detail {

/// Points and polygons as read, in file coordinates and full precision.
struct Soup {
  std::vector<glm::dvec3> points;
  std::vector<glm::vec3> normals;    ///< one a point, any length, or empty
  std::vector<glm::u8vec3> colours;  ///< one a point, or empty
  std::vector<glm::dvec2>
      places;  ///< one a point, on a picture, or empty: of parts that a reader has yet to colour
  std::vector<std::uint32_t> corners;  ///< point indices of all polygons, one polygon after the other
  std::vector<std::uint32_t> sizes;    ///< number of corners of every polygon
  std::vector<std::string> notes;      ///< warnings, without the file's name

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    corners.insert(corners.end(), {a, b, c});
    sizes.push_back(3);
  }
};

/// A file's bytes and the name for its errors.
struct Source {
  std::string name;
  std::filesystem::path path;
  std::string bytes;
};

/// \throws IoError the file cannot be read   \throws InputError it is empty
Source read_source(const std::filesystem::path& path);

// Readers.  All throw IoError for a file that ends too early, InputError (with the place) for one that is not
// what its name says.
Soup read_ply(const Source& source);
Soup read_obj(const Source& source);
Soup read_stl(const Source& source);
Soup read_off(const Source& source);
Soup read_gltf(const Source& source);
Soup read_drc(const Source& source);
Soup read_xyz(const Source& source);

/// Checks, triangulates, welds and cleans (see load()).
Loaded clean(Soup soup, const std::string& name, Weld which = Weld::Places,
             Content content = Content::OnePiece);

}  // namespace rejoin::mesh::detail
