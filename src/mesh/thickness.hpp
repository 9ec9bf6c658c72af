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
  std::vector<float>
      across;  ///< of every 16th sample, if its ray leaves squarely: the body's shortest chord through the
               ///< ray's middle, at right angles to it, mesh units; else +infinity
};

/// \param normals  smoothed outward normals of the samples
InwardRays cast_inwards(const Mesh& mesh, const Samples& samples, const std::vector<glm::vec3>& normals);

/// The walls of a sherd.
struct Walls {
  double thickness = 0;  ///< mesh units; 0: the piece is solid
  float roughest = 0;    ///< roughness that breaks alone exceed; 0: walls may be as rough
};

/// The thickness is the most frequent length of rays that leave squarely, if it makes the piece thin: at least a third of the surface has an
/// opposite wall at 0.6 to 1.6 of it, and it is small (0.12) against the piece's size.  Or if it makes a small sherd of a thick vessel, up to
/// 0.2 of its size, half of whose surface has a parallel wall at 0.8 to 1.25 of it or nearer than 0.25 of its size.  Or one of up to 0.3 of
/// its size, if three twentieths of its surface have such a wall, face about one direction or its opposite, unlike those of a rod, and are half
/// as rough as the rest: so are walls against breaks.  A rod, more than four times as long as wide and less than 2.3 times as wide as thick,
/// has no walls.
/// \param normals, roughness  of the samples
/// \param size  diameter of the piece, mesh units
Walls find_walls(const InwardRays& rays, const std::vector<glm::vec3>& normals,
                 const std::vector<float>& roughness, double size);

}  // namespace rejoin::mesh
