/// Triangles that are drawn many times.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "mesh/mesh.hpp"
#include "zbuffer/depth_map.hpp"

namespace rejoin::zbuffer {

/// A mesh's triangles made ready for the SIMD rasteriser.  Copies share them.
class Triangles {
 public:
  /// None.
  Triangles() = default;
  explicit Triangles(const mesh::Mesh& mesh);

  /// Draws the points linear * p + offset: x, y in pixel coordinates of the map, z = distance.  Covers exactly what draw()
  /// covers, but for closed surfaces that pass through themselves: what they enclose inside out is seen from its far side;
  /// depths differ by rounding only.
  void draw(const glm::mat3& linear, const glm::vec3& offset, DepthMap& map) const;

 private:
  struct Soup;
  std::shared_ptr<const Soup> soup_;
};

}  // namespace rejoin::zbuffer
