/// How noisy a scan is.
#pragma once

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// Noise of a scan's points across its surface: their root mean square distance from the quadric through their 20 nearest ones, in
/// the smoothest quarter of up to 2,000 places; relief that is not finer than the points are spaced counts little.  Mesh units;
/// 0 for fewer than 20 points.
double noise(const Mesh& mesh);

}  // namespace rejoin::mesh
