/// What contacts say that no search looked for.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "assembly/evidence.hpp"
#include "match/align.hpp"

namespace rejoin::assembly {

/// Log-odds that a contact which was not searched for speaks for (or, below 0, against) the pose that made it: how much of the
/// surfaces that lie over each other touches, and how much shape agrees.  \source docs/scoring.md
/// \param in_plane  the contact lies in one plane with that which made the pose, within a touching distance: flat surfaces of one plane
///                  touch together, so that touching speaks for nothing there, and shape alone does
double witness_odds(const match::Evidence& evidence, bool in_plane);

/// Puts groups together as links between them say, one link fewer than groups, aligns them on all contacts between them, and
/// adds up the log-odds that those of other pairs than the links' own give.
/// \param groups  the first, best the largest, stays; the others are aligned to it
/// \param poses   of all pieces, those of the groups in one frame: where the links put them
/// \return 0 if no other pair touches, or if the contacts pull a link's pair apart; nothing if pieces would lie in each other
std::optional<double> witness_odds(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                   const std::vector<std::vector<std::size_t>>& groups,
                                   std::vector<Rigid> poses, const Options& options);

/// Whether a link says that two pieces lie so.
using IsLinked = std::function<bool(std::size_t a, std::size_t b, const Rigid& b_to_a)>;

/// What witness_odds() adds up, of all contacts and of those alone that no link knows.
struct Heard {
  double all = 0;
  double unlinked = 0;
};

/// The same as witness_odds(), asked once for both.
std::optional<Heard> hear_contacts(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                   const std::vector<std::vector<std::size_t>>& groups,
                                   std::vector<Rigid> poses, const Options& options,
                                   const IsLinked& is_linked);

}  // namespace rejoin::assembly
