/// Takes the noise of a scan off its surface.
#pragma once

#include "mesh/mesh.hpp"

namespace rejoin::mesh {

/// The surface with its vertices moved onto the quadrics that fit their neighbours best, which lie on the same side of edges, and along
/// the surface to the middle of their ring, as noise folds faces over.  Shape much smaller than the radius is lost with the noise.
/// \param mesh    with faces; colours and normals are left as they are
/// \param radius  of the neighbourhood, mesh units
/// \source Alexa, Behr, Cohen-Or, Fleishman, Levin, Silva: Computing and rendering point set surfaces (2003), section 3
Mesh smooth(const Mesh& mesh, double radius);

/// A radius, in spacings of the points (resolution()), for scans as noisy as a tenth to a third of that, and the share of noise() that it
/// leaves.
inline constexpr double kSmoothRadius = 3.0;
inline constexpr double kNoiseLeft = 0.41;

}  // namespace rejoin::mesh
