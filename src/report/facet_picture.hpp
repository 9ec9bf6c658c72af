/// The segmentation of a fragment as a picture, so that a user can see where it is wrong.
#pragma once

#include <string>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"
#include "report/image.hpp"

namespace rejoin::report {

/// Colour of a facet: distinct and bright for fracture, grey for original surface, dark where there is no facet.
/// \param number  into facets.facets; -1: none
Colour facet_colour(int number, const mesh::Segmentation& facets);

/// The surface from six sides, every facet in its colour, with its number (numbered_picture.hpp).
/// \param title    first line of the picture
/// \throws InputError the surface has no faces
Image facet_picture(const mesh::Mesh& surface, const mesh::Segmentation& facets, const std::string& title);

}  // namespace rejoin::report
