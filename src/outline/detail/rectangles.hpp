/// What lies beside the pieces in a picture and is none of them.
#pragma once

#include "outline/read.hpp"

namespace rejoin::outline::detail {

/// Whether a picture's outline is a rectangle, each of whose sides is straight to 0.8 pixels (rms) or evenly bowed by up to 0.5 % of its
/// length, as by a lens, perhaps with
/// rounded corners or a little askew.
bool is_rectangle(const Outline& outline);

/// Takes the rectangles out of a folder's set that lie in one picture with other pieces, as rulers, labels and colour cards do, into
/// `left_out`, with a note.  Straight edges join nothing, but their length would be that of the borders that are looked for.
/// What may have been cut out of another piece, which has a hole for it, stays, and so do all if no two pieces would be left.
void take_out_rectangles(PieceSet& set);

}  // namespace rejoin::outline::detail
