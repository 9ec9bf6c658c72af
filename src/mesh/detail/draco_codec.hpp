/// Draco decoding, for .drc files and for glTF.
#pragma once

#include <optional>
#include <string_view>

#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

/// Attribute numbers that glTF names; nullopt: found by their kind, as in a .drc file.
struct DracoAttributes {
  std::optional<int> position;
  std::optional<int> normal;
  std::optional<int> colour;
  std::optional<int> place;  ///< on a picture; not read where it is not told
};

/// \param name  file, for errors
/// \throws InputError not Draco data, damaged, or without positions
Soup decode_draco(std::string_view bytes, const std::string& name, const DracoAttributes& attributes = {});

/// Draco data of triangles (or of a cloud, without faces).  Points near the origin are quantised to
/// 2^-20 of the box's longest side; far from the origin they are stored whole, in double precision.
///
/// \throws IoError the encoder failed
std::string encode_draco(const Soup& soup, bool far_from_origin, const std::string& name);

}  // namespace rejoin::mesh::detail
