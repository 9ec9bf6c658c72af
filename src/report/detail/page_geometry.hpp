/// Surfaces packed for the page of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::report::detail {

/// A surface as the page's viewer reads it.  Positions are 16-bit steps of `step` from `low`; both streams are
/// compressed by meshoptimizer's vertex and index codecs.
struct PackedMesh {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  glm::dvec3 low{0.0};  ///< file coordinates
  double step = 0;      ///< mesh units
  /// 8 bytes a vertex: x, y, z as uint16, gap as uint8, 0.  Gap: 0 = no contact, else 128 + 127 * gap / gap_scale.
  std::vector<std::uint8_t> vertex_stream;
  std::vector<std::uint8_t> colour_stream;  ///< 4 bytes a vertex: red, green, blue, 255; empty: no colours
  std::vector<std::uint8_t> index_stream;

  std::size_t bytes() const { return vertex_stream.size() + colour_stream.size() + index_stream.size(); }
};

/// \param mesh   with faces
/// \param gaps   one a vertex of mesh, mesh units, NaN = no contact; or empty
/// \param gap_scale  |gap| of the strongest colour, > 0
PackedMesh pack(const mesh::Mesh& mesh, const std::vector<float>& gaps, double gap_scale);

/// The bytes as base64 (RFC 4648, with padding).
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace rejoin::report::detail
