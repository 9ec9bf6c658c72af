/// What a candidate is worth, and whether two poses are the same.
#pragma once

#include "assembly/assembly.hpp"
#include "assembly/piece.hpp"
#include "match/align.hpp"

namespace rejoin::assembly {

/// log(score / (1 - score)), kept within +-12 so that no single join outweighs everything.
double log_odds(double score);

/// Of the contact of two pieces as they lie, without any alignment; weighed as the joints of a search are, and at most as likely as not
/// where one piece slides along the other: it holds no pose.
match::Evidence contact_evidence(const Piece& a, const Piece& b, const Rigid& b_to_a);

/// Whether two poses of b against a agree as far as the options ask.
bool same_pose(const Piece& a, const Piece& b, const Rigid& first, const Rigid& second,
               const Options& options);

}  // namespace rejoin::assembly
