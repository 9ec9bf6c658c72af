/// Fracture against original surface, and fracture surface cut into facets.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rigid.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// One piece of surface that is seen as a whole from its mean normal.
struct Facet {
  std::vector<std::uint32_t> faces;   ///< into the segmented mesh
  glm::dvec3 normal{0, 0, 1};         ///< area-weighted mean, unit, outwards
  glm::dvec3 centre{0.0};             ///< area-weighted, relative to the mesh's origin
  glm::dvec3 along{1, 0, 0};          ///< longest in-plane direction, unit
  double length = 0;                  ///< extent along `along`, mesh units
  double width = 0;                   ///< extent across it
  double area = 0;                    ///< squared mesh units
  double roughness = 0;               ///< how irregular: rms deviation of the normals from their smoothed course, radians
  bool fracture = false;              ///< broken surface (may join), else original surface
};

struct Segmentation {
  std::vector<Facet> facets;          ///< fracture facets first, largest first in each class
  std::vector<int> facet_of_face;     ///< index into facets, -1 where none
  double wall_thickness = 0;          ///< most frequent wall thickness, mesh units; 0 for a solid piece
};

/// Segments a surface.
/// \pre the mesh has faces
/// \source papaioannou 2002, section 6.2 (mean normals of the most irregular compact facets)
Segmentation segment(const Mesh& mesh);

}  // namespace rejoin::mesh
