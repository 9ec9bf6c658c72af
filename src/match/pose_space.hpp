/// The seven numbers of the search, the views that they stand for, and the rigid motion of a view in contact.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"
#include "zbuffer/depth_map.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::match {

inline constexpr std::size_t kPoseSize = 7;

/// Where each of the paper's numbers stands in a pose vector: angles in radians, shifts in mesh units.
enum PoseIndex : std::size_t { kTheta1, kPhi1, kRho1, kX1, kY1, kTheta2, kPhi2 };

using PoseVector = std::array<double, kPoseSize>;

/// When fragment 1 turns about Z.
enum class RotationOrder {
  ZLast,   ///< M1 = T Rz Rx Ry: the general form
  ZFirst,  ///< M1 = T Rx Ry Rz: keeps material axes that were laid along Z collinear
};

/// Fixed motions before (rotations, file axes -> view axes) and after (shift of fragment 1) those of the
/// pose.
struct Alignment {
  glm::dmat3 rotation_a{1.0};
  glm::dmat3 rotation_b{1.0};
  glm::dvec2 shift_a{0.0};  ///< mesh units
};

/// The view of a pose: M1 = T(x1, y1, 0) Rz(rho1) Rx(theta1) Ry(phi1), M2 = Rx(theta2) Ry(phi2), each after
/// its alignment. \pre pose.size() == kPoseSize \source papaioannou 2002, section 2, and 5.2.1 for the order
/// ZFirst; deviation: none.
zbuffer::ViewPair view_of(std::span<const double> pose, const Alignment& alignment, RotationOrder order);

/// Centre of the smallest ball around the vertices (to about 1 % of its radius), relative to the mesh's
/// origin.  That radius is at most 0.613 of the diameter (Jung), so the view cube of side 1.3 R holds the fragment at
/// every rotation; around the surface's centroid it does not always.
glm::dvec3 view_centre(const mesh::Mesh& mesh);

/// How close the surfaces come at contact.
struct ContactOptions {
  double percentile = 0.95;  ///< share of the facing pixel pairs that must not penetrate, 0 .. 1
};

/// How far B's view frame lies from A's along Z when the surfaces touch: the point (x, y, z) of B's view
/// stands at
/// (-x, y, offset - z) in A's.  Over the pixels that both maps cover, the surfaces touch at z_a + z_b; the
/// offset is a high percentile of that, so that single spikes, edges that a pixel straddles and scanner noise
/// do not hold the fragments apart, while at most the rest of the pixels penetrate. \param a, b       maps as
/// rendered (b not mirrored), same shape, depths f_R / 2 - z \param view_side  f_R, mesh units \return mesh
/// units; f_R where the maps do not overlap (the fragments then stand apart, each in its own cube) \throws
/// InputError if the shapes differ
double contact_offset(const zbuffer::DepthMap& a, const zbuffer::DepthMap& b, double view_side,
                      const ContactOptions& options = {});

/// Points that a view turns about, in file coordinates: mesh.origin + ViewOptions::centre.
struct ViewCentres {
  glm::dvec3 a{0.0};
  glm::dvec3 b{0.0};
};

/// The rigid motion from B's file coordinates to A's that brings the fragments together as the view shows
/// them: B is turned by half a turn about Y to face A and put at `offset` along Z.
Rigid pose_of(const zbuffer::ViewPair& view, double offset, const ViewCentres& centres);

/// A view with its offset: what pose_of() takes.
struct FacingView {
  zbuffer::ViewPair view;
  double offset = 0;
};

/// The inverse of pose_of(): the view of a given pose along `direction`.
/// \param direction  unit, A's file axes; becomes +Z, the direction in which A faces B
FacingView facing_view(const Rigid& pose, const glm::dvec3& direction, const ViewCentres& centres);

}  // namespace rejoin::match
