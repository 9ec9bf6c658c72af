/// Ray and nearest-surface queries on one mesh (Embree behind it).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Queries in the mesh's own frame (relative to mesh.origin).  Const members may be called from several
/// threads.
class RayScene {
 public:
  /// \param mesh  kept by reference, must outlive the scene.  \pre the mesh has faces
  explicit RayScene(const Mesh& mesh);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  struct Hit {
    float distance;  ///< mesh units along the ray, or from the query point
    std::uint32_t face;
    glm::vec3 point;
  };

  /// First surface met between `near` and `far` along the unit vector `direction`.
  std::optional<Hit> first_hit(const glm::vec3& start, const glm::vec3& direction, float near,
                               float far) const;

  /// Nearest point of the surface within `radius`.
  std::optional<Hit> nearest(const glm::vec3& point, float radius) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rejoin::mesh
