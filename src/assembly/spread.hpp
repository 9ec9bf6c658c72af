/// Alignment of all fragments of an assembly together.
#pragma once

#include <utility>
#include <vector>

#include "assembly/piece.hpp"

namespace rejoin::assembly {

/// Where the pose of two pieces comes from.
enum class Known {
  Searched,  ///< the pair's own alignment said its pose
  Asked,     ///< whether the two fit where others put them is to be seen; the pose holds nothing
  Met,  ///< they touch where others put them; the pose holds nothing, and what does not touch is not pulled together
};

/// Two pieces that touch, or may.
struct Touching {
  std::size_t a = 0;  ///< into the pieces
  std::size_t b = 0;
  Rigid pose;  ///< b -> a, file coordinates
  Known known = Known::Searched;
};

/// Moves the members of a group so that all their contacts fit as well as they can together: robust point-to-plane
/// residuals between the broken surfaces of every touching pair, both ways, each pair by its area, and a weak pull towards the pairs' own poses
/// that holds what contact leaves free.  Gauss-Newton with Tukey weights whose reach shrinks.
/// \param members  piece numbers
/// \param poses    file coordinates -> common frame, one a piece; those of the members are changed
/// \param fixed    members that stay; empty: the first member stays
void spread_error(const std::vector<Piece>& pieces, const std::vector<std::size_t>& members,
                  const std::vector<Touching>& contacts, const std::vector<std::size_t>& fixed,
                  std::vector<Rigid>& poses);

}  // namespace rejoin::assembly
