/// What contacts say that no search looked for.
#pragma once

#include <vector>

#include "assembly/evidence.hpp"
#include "match/align.hpp"

namespace rejoin::assembly {

/// Log-odds that a contact which was not searched for speaks for (or, below 0, against) the pose that made it: how much of the
/// surfaces that lie over each other touches, and how much shape agrees.  \source docs/scoring.md
double witness_odds(const match::Evidence& evidence);

/// Puts two groups together as one link says, aligns them on all contacts between them, and adds up the log-odds that those
/// of other pairs than the link's own give.
/// \param poses  of all pieces, those of both groups in one frame: where the link would put them
/// \param stay   pieces of the one group
/// \param move   of the other; as few as possible: they are what is aligned
/// \return 0 if no other pair touches, if pieces would lie in each other, or if the contacts pull the link's pair apart
double witness_odds(const std::vector<Piece>& pieces, const Link& link, std::vector<Rigid> poses,
                    const std::vector<std::size_t>& stay, const std::vector<std::size_t>& move,
                    const Options& options);

}  // namespace rejoin::assembly
