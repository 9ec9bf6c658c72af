/// Surfaces with known answers, and a place for files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::test {

/// Sphere about the origin, 20 * 4^level faces.
Mesh icosphere(float radius, int level);

/// Box -size/2 .. size/2, every side cut into cells x cells x 2 faces, closed, wound outwards.
Mesh box(const glm::vec3& size, int cells);

/// Dart throwing: keeps points of `draw` that are at least `spacing` from all kept ones, until none has fitted for long.
Mesh spread(float spacing, const std::function<void(glm::vec3& point, glm::vec3& normal)>& draw);

/// Points spread evenly (no two closer than `spacing`) over a box's sides, with the sides' normals.
Mesh box_cloud(const glm::vec3& size, float spacing, std::uint64_t seed);

/// The same for a sphere about the origin.
Mesh sphere_cloud(float radius, float spacing, std::uint64_t seed);

/// How often edges are used, and whether a directed edge is used twice (faces wound against each other).
struct Edges {
  std::size_t total = 0;
  std::size_t open = 0;          ///< one face
  std::size_t non_manifold = 0;  ///< more than two faces
  std::size_t against = 0;       ///< directed edges of more than one face
};
Edges count_edges(const Mesh& mesh);

/// Volume that a closed surface encloses; negative if it is inside out.
double volume(const Mesh& mesh);

/// A folder of its own that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& bytes) const;

 private:
  std::filesystem::path path_;
};

/// The file's bytes.
std::string read_bytes(const std::filesystem::path& path);

/// As in data: URIs.
std::string base64(const std::string& bytes);

/// The bytes of a value, little-endian.
template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

}  // namespace rejoin::mesh::test
