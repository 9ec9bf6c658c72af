/// What a candidate is worth, and whether two poses are the same.
#pragma once

#include "assembly/assembly.hpp"
#include "assembly/piece.hpp"

namespace rejoin::assembly {

/// log(score / (1 - score)), kept within +-12 so that no single join outweighs everything.
double log_odds(double score);

/// Whether two poses of b against a agree as far as the options ask, or so many times as far.
bool same_pose(const Piece& a, const Piece& b, const Rigid& first, const Rigid& second,
               const Options& options, double times = 1.0);

}  // namespace rejoin::assembly
