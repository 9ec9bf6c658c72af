/// Evenly spread sample points of a surface: what segmentation and contact tests work on.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

struct Samples {
  std::vector<glm::vec3> points;     ///< on the surface, relative to the mesh's origin
  std::vector<glm::vec3> normals;    ///< unit, outwards: of the face the sample lies on
  std::vector<std::uint32_t> faces;  ///< the face each sample lies on
  std::vector<float> areas;  ///< surface that each stands for, squared mesh units: all but evenly spread, for
                             ///< a surface askew to the axes has more samples, of less area each
  double spacing = 0;        ///< typical distance of neighbours, mesh units

  std::size_t size() const { return points.size(); }
};

/// Samples a surface with one point in every occupied cell of a cubic grid, so that their density depends
/// neither on the tessellation nor on its level of detail.  Deterministic. \param count  about how many
/// points; the spacing follows from the surface's area \pre the mesh has faces
Samples sample_surface(const Mesh& mesh, std::size_t count);

/// The count for which sample_surface() has this spacing, mesh units.
std::size_t count_at(const Mesh& mesh, double spacing);

}  // namespace rejoin::mesh
