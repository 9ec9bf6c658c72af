/// How much border the placed pieces of one object share.
#pragma once

#include <cstddef>
#include <vector>

#include "outline/outline.hpp"

namespace rejoin::outline {

/// Border that two pieces share.
struct SharedBorder {
  std::size_t a = 0;  ///< positions in the list of pieces, a < b
  std::size_t b = 0;
  double length = 0.0;  ///< along the borders as the files have them, mean of both sides, file units
  double rms = 0.0;     ///< distance of the two borders along it, file units
};

/// Every place of a border goes to the nearest other piece, if that is within reach: where three pieces meet, none of the
/// border counts twice, and all that a piece surrounded by others shares is its perimeter.  Lengths are those of the
/// files' own borders, not smoothed.
/// \param members  of one object, positions in pieces and poses   \param poses  into the object's frame
/// \param reach    distance up to which borders meet, file units, > 0; what the borders really keep along their
///   contacts sets a shorter one, down to a third of it
/// \return pairs in ascending order, only those that share any
std::vector<SharedBorder> shared_borders(const std::vector<Piece>& pieces,
                                         const std::vector<std::size_t>& members,
                                         const std::vector<Planar>& poses, double reach);

}  // namespace rejoin::outline
