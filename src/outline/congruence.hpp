/// Whether two outlines are of one piece.
#pragma once

#include "outline/outline.hpp"

namespace rejoin::outline {

/// Whether a motion without turning over lays two outer borders on each other, but for what another scan, another format or
/// compression changes: areas within 1 %, and 95 % of the borders no farther apart than the points of a border are from each other, nor
/// than a thousandth of their length.  Pieces cut to one size are congruent too; broken ones only with themselves.
bool congruent(const Outline& a, const Outline& b);

/// The outer border as it is seen from the other side: congruent() with that of a picture of the piece's other side.
Outline turned_over(const Outline& a);

}  // namespace rejoin::outline
