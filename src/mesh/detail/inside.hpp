/// How far it is through a body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/ray_scene.hpp"

namespace rejoin::mesh::detail {

inline constexpr float kNoBody = std::numeric_limits<float>::infinity();

/// Looks from places of a surface through the body under it.  A ray leaves a body where it meets a face from behind; one that meets
/// a face's front, or nothing, was in no body.  Const members may be called from several threads.
class Inside {
 public:
  /// \param mesh  kept by reference, must outlive this.  \pre it has faces
  explicit Inside(const Mesh& mesh);

  /// Median thickness of the body, square to the surface, along rays within 25 degrees of its normal; kNoBody: most leave none on
  /// either side of the surface, whichever way it is wound.
  float thickness_at(const glm::vec3& place, const glm::vec3& normal) const;

  /// Whether that thickness is known and more than `limit`, in half the rays and less; false where it takes more of them to tell.
  bool is_thicker(const glm::vec3& place, const glm::vec3& normal, float limit) const;

  /// Faces through which such rays leave the body under the surface.
  std::vector<std::uint32_t> exits_from(const glm::vec3& place, const glm::vec3& normal) const;

  /// Share of all directions under the surface, evenly spread, in which rays leave a body.
  float enclosed_at(const glm::vec3& place, const glm::vec3& normal) const;

 private:
  std::optional<RayScene::Hit> exit(const glm::vec3& place, const glm::vec3& direction,
                                    float farthest = kNoBody) const;
  float thickness_under(const glm::vec3& place, const glm::vec3& normal) const;

  RayScene scene_;
  std::vector<glm::vec3> face_normals_;
  std::vector<glm::vec3> narrow_;  ///< directions near z
  std::vector<glm::vec3> wide_;    ///< over the half sphere
  float start_;                    ///< behind the place, over rounding
};

}  // namespace rejoin::mesh::detail
