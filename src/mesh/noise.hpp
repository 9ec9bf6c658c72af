/// How noisy a scan is.
#pragma once

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Noise of a scan's points across its surface: the root mean square distance of points from the quadric through the 20 nearest
/// ones that face the same way (the far side of a thin wall does not).  Of up to 4,000 places a quarter has less; so relief counts
/// little, and most where it is as fine as the points' spacing.  Mesh units; 0 where no place has 12 such points.
/// \pre the mesh has faces
double noise(const Mesh& mesh);

/// Whether noise() told the noise of a scanner, which a quadric over more points leaves as it is.  What shape there is between points
/// that are too far apart for it grows with the surroundings.  Of fewer than 900 points nothing can be told.
/// \param noise  of the mesh
bool is_of_scanner(double noise, const Mesh& mesh);

}  // namespace rejoin::mesh
