/// A picture of assembled objects.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"
#include "report/image.hpp"

namespace rejoin::report {

struct PlacedFragment {
  std::string name;
  const mesh::Mesh* mesh;  ///< not owned; must have faces
  Rigid pose;              ///< file coordinates -> common frame
  int group = 0;
  Colour colour{0};
};

/// The largest groups, at most four, one row each: seen from four sides, each fragment in its colour, and the names.
/// \pre fragments is not empty
Image assembly_picture(const std::vector<PlacedFragment>& fragments);

/// \throws IoError the file cannot be written
void write_assembly_picture(const std::filesystem::path& path, const std::vector<PlacedFragment>& fragments);

}  // namespace rejoin::report
