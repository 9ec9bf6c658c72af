/// The pieces of a scan that holds several.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/image.hpp"

namespace rejoin::report {

/// The pieces where they lie from six sides, each in its colour and with its number, from 1 (numbered_picture.hpp).
/// \param pieces  meshes, or clouds, through whose points surfaces are laid
/// \throws InputError none of the pieces has a surface
Image split_picture(const std::string& title, const std::vector<mesh::Mesh>& pieces);

/// Pictures of one width, one below the other.  \pre there is one
Image stacked(const std::vector<Image>& images);

}  // namespace rejoin::report
