/// The segmentation of a fragment as a picture, so that a user can see where it is wrong.
#pragma once

#include <string>
#include <vector>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"
#include "report/image.hpp"
#include "report/renderer.hpp"

namespace rejoin::report {

/// Colour of a facet: distinct and bright for fracture, grey for original surface, dark where there is no facet.
/// \param number  into facets.facets; -1: none
Colour facet_colour(int number, const mesh::Segmentation& facets);

/// Where a facet's number goes in a view.
struct FacetLabel {
  int facet = -1;  ///< into facets.facets
  int x = 0;       ///< of the pixel of the facet that is farthest from its border
  int y = 0;
  double room = 0;  ///< from there to the nearest pixel that is not the facet's, pixels
};

/// One label for each facet that the view shows, by number; facets that others hide in part are labelled on what is seen.
/// \param facet_of_face  -1: none
std::vector<FacetLabel> facet_labels(const Visibility& seen, const std::vector<int>& facet_of_face);

/// The surface from six sides, every facet in its colour, with its number in every view where there is room for it, or in the one
/// where there is most.
/// \param title    first line of the picture
/// \throws InputError the surface has no faces
Image facet_picture(const mesh::Mesh& surface, const mesh::Segmentation& facets, const std::string& title);

}  // namespace rejoin::report
