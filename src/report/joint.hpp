/// What the pictures of a joint are made from.
#pragma once

#include <vector>

#include "core/rigid.hpp"
#include "match/gap.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::report {

/// Two surfaces at a pose, how far apart they are, and the axes of their joint.  Everything in A's file
/// coordinates.
struct Joint {
  mesh::Mesh a;  ///< at most kPictureFaces faces
  mesh::Mesh b;
  Rigid pose;                ///< B's file coordinates -> A's file coordinates
  std::vector<float> gap_a;  ///< one a vertex of a; NaN where there is no contact
  std::vector<float> gap_b;  ///< one a vertex of b
  double reach = 0;          ///< gaps above this are "no contact", mesh units; a round number
  double scale = 0;  ///< |gap| of the strongest colours (kMedianGaps), <= reach, mesh units; a round number
  match::Contact contact;      ///< of a, within reach; area 0 if the surfaces do not meet
  glm::dvec3 centre{0.0};      ///< of the contact; between the fragments if there is none
  glm::dvec3 normal{0, 0, 1};  ///< unit, from A to B
  glm::dvec3 along{1, 0, 0};   ///< longest direction of the contact, unit, perpendicular to normal
  glm::dvec3 across{0, 1, 0};  ///< cross(normal, along)
  double length = 0;           ///< extent of the contact along `along`, mesh units
  double width = 0;            ///< extent across it
};

inline constexpr std::size_t kPictureFaces = 300000;  ///< finer than any pixel of the pictures

/// \param a, b        full surfaces; larger ones are simplified first
/// \param direction   from A to B, unit, A's axes; used where there is no contact.  (0,0,0): from centroid to
///         centroid
/// \param resolution  sample spacing of the scans, mesh units: gaps are never judged finer
/// \throws InputError a surface without faces
Joint make_joint(const mesh::Mesh& a, const mesh::Mesh& b, const Rigid& pose, const glm::dvec3& direction,
                 double resolution);

}  // namespace rejoin::report
