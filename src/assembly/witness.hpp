/// What contacts say that no search looked for.
#pragma once

#include <vector>

#include "assembly/evidence.hpp"

namespace rejoin::assembly {

/// Log-odds that `strength`, the sum of match::strength() over such contacts, adds to a join; 0 for next to none.
/// A contact that was not searched for has no reason to fit if the pose is wrong: docs/scoring.md has figures.
double witness_odds(double strength);

/// Puts two groups together as one link says, aligns them on all contacts between them, and adds up the strengths of those
/// of other pairs than the link's own.
/// \param poses  of all pieces, those of both groups in one frame: where the link would put them
/// \param stay   pieces of the one group
/// \param move   of the other; as few as possible: they are what is aligned
/// \return 0 if no other pair touches, if pieces would lie in each other, or if the contacts pull the link's pair apart
double witness_strength(const std::vector<Piece>& pieces, const Link& link, std::vector<Rigid> poses,
                        const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move,
                        const Options& options);

}  // namespace rejoin::assembly
