#include "report/detail/page_geometry.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rejoin::report::detail {
namespace {

constexpr double kSteps = 65535.0;

struct PackedVertex {
  std::array<std::uint16_t, 3> position;
  std::uint8_t gap;
  std::uint8_t unused;
};
static_assert(sizeof(PackedVertex) == 8);

struct PackedColour {
  std::array<std::uint8_t, 4> rgba;
};

std::uint8_t packed_gap(float gap, double scale) {
  if (std::isnan(gap)) return 0;
  return static_cast<std::uint8_t>(std::lround(128.0 + 127.0 * std::clamp(gap / scale, -1.0, 1.0)));
}

template <typename Vertex>
std::vector<std::uint8_t> encoded(const std::vector<Vertex>& vertices) {
  std::vector<std::uint8_t> stream(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)));
  stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), vertices.data(), vertices.size(),
                                           sizeof(Vertex)));
  return stream;
}

/// The corners of all faces, ordered so that the codec finds much to share.
std::vector<unsigned int> ordered_corners(const mesh::Mesh& mesh) {
  std::vector<unsigned int> corners;
  corners.reserve(3 * mesh.faces.size());
  for (const glm::uvec3& face : mesh.faces) corners.insert(corners.end(), {face.x, face.y, face.z});
  meshopt_optimizeVertexCacheStrip(corners.data(), corners.data(), corners.size(), mesh.vertices.size());
  return corners;
}

/// New number of every vertex, in the order in which the faces first use them; unused ones are left out.
std::size_t renumber(std::vector<unsigned int>& corners, std::vector<unsigned int>& old_of_new,
                     std::size_t vertices) {
  std::vector<unsigned int> map(vertices);
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(map.data(), corners.data(), corners.size(), vertices);
  old_of_new.assign(used, 0);
  for (std::size_t k = 0; k < vertices; ++k) {
    if (map[k] < used) old_of_new[map[k]] = static_cast<unsigned int>(k);
  }
  for (unsigned int& corner : corners) corner = map[corner];
  return used;
}

}  // namespace

PackedMesh pack(const mesh::Mesh& mesh, const std::vector<float>& gaps, double gap_scale) {
  PackedMesh packed;
  const mesh::Box box = mesh::bounds(mesh);
  const glm::dvec3 extent = glm::dvec3(box.high) - glm::dvec3(box.low);
  packed.low = mesh.origin + glm::dvec3(box.low);
  const double side = std::max({extent.x, extent.y, extent.z});
  packed.step = side > 0 ? side / kSteps : 1.0;
  std::vector<unsigned int> corners = ordered_corners(mesh);
  std::vector<unsigned int> old_of_new;
  packed.vertices = renumber(corners, old_of_new, mesh.vertices.size());
  packed.faces = mesh.faces.size();
  std::vector<PackedVertex> vertices;
  vertices.reserve(packed.vertices);
  std::vector<PackedColour> colours;
  colours.reserve(mesh.colours.empty() ? 0 : packed.vertices);
  for (const unsigned int old : old_of_new) {
    const glm::dvec3 at = (glm::dvec3(mesh.vertices[old]) - glm::dvec3(box.low)) / packed.step;
    vertices.push_back({{static_cast<std::uint16_t>(std::lround(std::min(at.x, kSteps))),
                         static_cast<std::uint16_t>(std::lround(std::min(at.y, kSteps))),
                         static_cast<std::uint16_t>(std::lround(std::min(at.z, kSteps)))},
                        gaps.empty() ? std::uint8_t{0} : packed_gap(gaps[old], gap_scale),
                        0});
    if (mesh.colours.empty()) continue;
    const glm::u8vec3& c = mesh.colours[old];
    colours.push_back({{c.r, c.g, c.b, 255}});
  }
  packed.vertex_stream = encoded(vertices);
  if (!colours.empty()) packed.colour_stream = encoded(colours);
  packed.index_stream.resize(meshopt_encodeIndexBufferBound(corners.size(), packed.vertices));
  packed.index_stream.resize(meshopt_encodeIndexBuffer(packed.index_stream.data(), packed.index_stream.size(),
                                                       corners.data(), corners.size()));
  return packed;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::array<char, 65> kDigits{
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"};
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - k);
    const unsigned word = static_cast<unsigned>(bytes[k]) << 16U |
                          (left > 1 ? static_cast<unsigned>(bytes[k + 1]) << 8U : 0U) |
                          (left > 2 ? static_cast<unsigned>(bytes[k + 2]) : 0U);
    text += kDigits[word >> 18U];
    text += kDigits[word >> 12U & 63U];
    text += left > 1 ? kDigits[word >> 6U & 63U] : '=';
    text += left > 2 ? kDigits[word & 63U] : '=';
  }
  return text;
}

}  // namespace rejoin::report::detail
