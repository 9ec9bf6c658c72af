/// Pieces that are in a folder twice.
#pragma once

#include "outline/read.hpp"

namespace rejoin::outline::detail {

/// Leaves out what repeats another piece: a copy of its file, or its picture in another format.  Pieces whose outlines alone are the
/// same, as those of cards of one size, stay.  The shortest name stays, as copies are mostly called "copy of" or "(2)".
void take_out_repeats(PieceSet& set);

}  // namespace rejoin::outline::detail
