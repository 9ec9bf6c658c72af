/// Wall thickness of thin pieces, the natural unit for sherds.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/samples.hpp"

namespace rejoin::mesh {

/// Length of the ray from every sample straight inwards to the surface that it leaves the body through, and
/// how squarely it leaves.
struct InwardRays {
  std::vector<float> length;  ///< mesh units; +infinity where the ray meets nothing
  std::vector<float>
      square;  ///< cosine between the ray and the outward normal where it leaves: 1 = parallel walls
};

/// \param normals  smoothed outward normals of the samples
InwardRays cast_inwards(const Mesh& mesh, const Samples& samples, const std::vector<glm::vec3>& normals);

/// The most frequent length of rays that leave squarely, if it makes the piece thin: at least a third of the surface has an
/// opposite wall at 0.6 to 1.6 of it, and it is small (0.12) against the piece's size; or a small sherd of a thick vessel, up to
/// 0.2 of its size, half of whose surface has a parallel wall at 0.8 to 1.25 of it.  0 otherwise.
/// \param size  diameter of the piece, mesh units
double wall_thickness(const InwardRays& rays, double size);

}  // namespace rejoin::mesh
