/// How noisy a scan is.
#pragma once

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Noise of a scan's points across its surface: their root mean square distance from the quadric through the 20 nearest ones that
/// face the same way (the far side of a thin wall does not), in the smoothest quarter of up to 4,000 places.  Relief much wider
/// than the points' spacing counts little.  Mesh units; 0 where no place has 12 such points.
/// \pre the mesh has faces
double noise(const Mesh& mesh);

}  // namespace rejoin::mesh
