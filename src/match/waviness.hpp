/// How far the surface of a scan strays from a smooth one.
#pragma once

#include "mesh/facets.hpp"

namespace rejoin::match {

/// Robust deviation of surface from the quadric through its surroundings, where these are smoothest: a quarter of up to 1000 places has less.
/// Of sherds the walls are looked at, in surroundings of 1.5 wall thicknesses; of solid pieces all of it, in 7.5 spacings of samples or points.
/// Relief counts little as long as it leaves places free; errors that near points of a scan share, as those of models from
/// photographs do, are everywhere.  What is smoother than any scan, as a filled hole, does not count.
/// \param size        diameter, mesh units
/// \param resolution  of the scan, mesh units
/// \return mesh units; infinite where less than five places are surrounded by surface, as on small sherds
double waviness(const mesh::Segmentation& facets, double size, double resolution);

}  // namespace rejoin::match
