/// Signed distance from one fragment's surface to the other's at a pose.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"
#include "mesh/ray_scene.hpp"

namespace rejoin::match {

/// Unit normals (0 without area) for the question whether two surfaces face each other, one a vertex.
struct FacingNormals {
  std::vector<glm::vec3> near;  ///< over the adjacent faces: right up to an edge, but noisy on scans
  std::vector<glm::vec3> calm;  ///< over two rings of faces: the other way round
};
FacingNormals facing_normals(const mesh::Mesh& mesh);

/// Signed distances to one surface; made once, asked at many poses.  Const members may be called from several
/// threads.
class GapField {
 public:
  /// \param surface  kept by reference, must outlive the field
  /// \throws InputError  the surface has no faces
  explicit GapField(const mesh::Mesh& surface);

  struct Sample {
    float gap;              ///< mesh units; above 0 outside the surface, below 0 inside it
    glm::vec3 normal;       ///< outwards at the nearest point (FacingNormals::near), unit or 0
    glm::vec3 calm_normal;  ///< FacingNormals::calm
    std::uint32_t face;     ///< that holds the nearest point
  };

  /// The surface's nearest point within max_distance.
  ///
  /// The sign comes from the normal of the feature that is nearest (face, edge or corner), so it is right
  /// next to sharp edges too; where the wider surroundings say otherwise (slivers that are folded over turn
  /// that normal, however small they are), a ray away from the surface decides.  Beyond the border of
  /// an open surface it tells on which side of the border's faces the point lies.
  /// \param point         in the surface's own frame (relative to surface.origin)
  /// \param max_distance  mesh units
  /// \source Baerentzen and Aanaes 2005, angle-weighted pseudonormals.  Deviation: an edge's normal is the
  ///         mean of its corners' instead of its faces'; the two agree but for the weights.
  std::optional<Sample> at(const glm::vec3& point, float max_distance) const;

  const mesh::Mesh& surface() const { return *surface_; }

 private:
  bool leaves_surface(const glm::vec3& start, const glm::vec3& direction, bool otherwise) const;

  const mesh::Mesh* surface_;
  mesh::RayScene scene_;
  std::vector<glm::vec3> corner_normals_;  ///< angle-weighted, one a vertex
  std::vector<glm::vec3> face_normals_;
  FacingNormals facing_normals_;
};

/// One entry a vertex of the asking surface.
struct Gaps {
  /// Mesh units, negative = penetration; NaN where nothing is within the distance asked for.
  std::vector<float> gap;
  /// -(normal . other normal): 1 = face to face, -1 = the same way; the larger answer of both kinds of
  /// normals, as each errs towards "not facing".  NaN like gap.
  std::vector<float> facing;
};

/// Gaps from every vertex of a to b's surface.
/// \param a             with faces, or a cloud with normals
/// \param b_to_a        B's file coordinates -> A's file coordinates
/// \param max_distance  mesh units; the smaller, the faster (0.02 diameters: about 0.05 s for 100,000 faces)
Gaps gaps(const mesh::Mesh& a, const GapField& b, const Rigid& b_to_a, double max_distance);

/// The signed distances alone, with a field made for this one call.
/// \throws InputError  b has no faces
std::vector<float> signed_gaps(const mesh::Mesh& a, const mesh::Mesh& b, const Rigid& b_to_a,
                               double max_distance);

/// What the gaps say of a joint.  A vertex is in contact if it has a gap and faces the other surface; it
/// counts with its share of the adjacent faces' area.
struct Contact {
  double area = 0;         ///< squared mesh units of a's surface
  double gap_median = 0;   ///< of |gap|, mesh units
  double gap_p90 = 0;      ///< 90 % of the contact's |gap| is below, mesh units
  double penetration = 0;  ///< mean of max(0, -gap), mesh units
  glm::dvec3 normal{0.0};  ///< mean outward normal of a's contact, unit, a's axes; 0 without contact
  glm::dvec3 centre{0.0};  ///< of the contact, a's file coordinates
};

inline constexpr float kFacing = 0.5F;  ///< cosine: normals within 60 degrees of face to face are in contact

/// \pre gaps were made for the same a
Contact contact_of(const mesh::Mesh& a, const Gaps& gaps);

/// True where the vertex has a gap and faces the other surface.
inline bool in_contact(const Gaps& gaps, std::size_t vertex) {
  return gaps.facing[vertex] >= kFacing;  // false for NaN
}

}  // namespace rejoin::match
