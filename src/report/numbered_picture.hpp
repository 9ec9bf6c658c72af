/// A surface from six sides, with numbers on its parts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "report/image.hpp"
#include "report/renderer.hpp"

namespace rejoin::report {

/// Where a part's number goes in a view.
struct PartLabel {
  int part = -1;
  int x = 0;  ///< of the pixel of the part that is farthest from its border
  int y = 0;
  double room = 0;  ///< from there to the nearest pixel that is not the part's, pixels
};

/// One label for each part that the view shows, by number; parts that others hide in part are labelled on what is seen.
/// \param part_of_face  -1: none
std::vector<PartLabel> part_labels(const Visibility& seen, const std::vector<int>& part_of_face);

/// What a numbered picture says and shows.
struct NumberedPicture {
  std::string title;
  std::string subtitle;
  std::vector<int> part_of_face;           ///< -1: none
  std::function<Colour(int part)> colour;  ///< of -1, too
  int first = 0;                           ///< number of part 0
};

/// The surface from six sides, every part in its colour, with its number in every view where there is room for it, or in the one
/// where there is most.
/// \throws InputError the surface has no faces
Image numbered_picture(const mesh::Mesh& surface, const NumberedPicture& what);

}  // namespace rejoin::report
