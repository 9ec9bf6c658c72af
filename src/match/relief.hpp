/// Slope maps and outlines of single facets: what the sweep correlates.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"
#include "zbuffer/triangles.hpp"

namespace rejoin::match {

/// A facet's own triangles in its plane frame: x along, y across, z along the facet's mean normal, origin at
/// its centre.
struct FacetPatch {
  std::vector<glm::vec3> points;  ///< mesh units
  zbuffer::Triangles triangles;   ///< between them
  glm::dmat3 frame{1.0};          ///< columns x, y, z in the mesh's axes; right-handed
  glm::dvec3 centre{0.0};         ///< relative to the mesh's origin
  double length = 0;              ///< extents of the points along x and y, mesh units
  double width = 0;
  double area = 0;    ///< squared mesh units, from the segmentation
  double across = 0;  ///< mean width, mesh units; of a strip that is bent across its course (match/strip.hpp)
};

/// \param facet_of_face  what mesh::facet_of_faces() gave for `mesh`
FacetPatch cut_patch(const mesh::Mesh& mesh, const std::vector<int>& facet_of_face, const mesh::Cut& cut,
                     int facet);

/// Slopes of a facet's relief on a regular grid, with little of the bend of the whole facet: breaks that are bent alike would agree
/// wherever they lie on one another.
struct ReliefMap {
  int width = 0;
  int height = 0;
  double pitch = 0;               ///< mesh units a pixel
  glm::dvec2 low{0.0};            ///< plane coordinates of pixel (0, 0)'s lower corner
  std::vector<float> height_map;  ///< relief, mesh units, NaN = background
  std::vector<float> slope_u;     ///< forward differences / pitch, less 0.8 of a quadric's; 0 where mask is 0
  std::vector<float> slope_v;
  std::vector<float> mask;  ///< 1 where both slopes are known and not steep, else 0
  // Told of the mask by count_pixels():
  std::vector<int> columns;  ///< pixels in each column
  std::vector<int> rows;     ///< and in each row
  int pixels = 0;            ///< in all
  int border = 0;            ///< sides of pixels between those of the mask and others
};

/// Fills what is told of the mask.
void count_pixels(ReliefMap& map);

/// Slopes steeper than this are left out: they belong to the facet's edge or to undercuts.
inline constexpr float kSteepest = 2.5F;

/// The relief as it is seen from outside along +z.
ReliefMap relief_of(const FacetPatch& patch, double pitch);

/// The relief that a partner facing this patch would need: the patch is turned over (half a turn about y),
/// then by `turn_rad` about z, and its slopes are taken of the surface that it turns to its partner. A
/// perfect partner's map has the same slopes and the same outline.
ReliefMap facing_relief_of(const FacetPatch& patch, double pitch, double turn_rad);

/// The plane that fits the space between two facing reliefs best: offset + tilt . (p - middle), in the first one's plane coordinates.
struct PlaneBetween {
  glm::dvec2 middle{0.0};  ///< of the overlap
  double offset = 0;       ///< mean sum of both heights, mesh units
  glm::dvec2 tilt{0.0};    ///< its slopes; 0 where the overlap is a line
};

/// \param facing  from facing_relief_of()
/// \param shift_u  pixel (i, j) of `fixed` lies on pixel (i - shift_u, j - shift_v) of `facing`
PlaneBetween plane_between(const ReliefMap& fixed, const ReliefMap& facing, int shift_u, int shift_v);

}  // namespace rejoin::match
