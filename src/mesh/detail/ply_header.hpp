/// Header of a PLY file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

/// Bytes of a binary value.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type;
  bool list = false;
  PlyType count_type = PlyType::Uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// Position of the named property, -1 if there is none.
  int find(const std::string& property) const;

  /// Least number of bytes that one instance takes in the file.
  std::size_t least_bytes(bool ascii) const;
};

struct PlyHeader {
  enum class Encoding { Ascii, Little, Big };
  Encoding encoding = Encoding::Ascii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;  ///< offset of the first byte after the header
};

/// \throws InputError not a PLY header (names the line)
PlyHeader read_ply_header(const Source& source);

}  // namespace rejoin::mesh::detail
