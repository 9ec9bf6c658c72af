/// Poses at which the rims of two sherds run along each other.
#pragma once

#include <cstddef>
#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "match/match.hpp"

namespace rejoin::rims {

struct ProposeOptions {
  std::size_t most = 40;  ///< proposals
};

/// One way in which b may join a, as far as the rims tell.
struct Proposal {
  Rigid pose;             ///< B's file coordinates -> A's
  double evidence = 0.0;  ///< how much more the rims agree than chance, natural logarithm
  double length = 0.0;    ///< of rim in contact, both walls together, mesh units
  double strength = 0.0;  ///< what the broken surfaces say at this pose, at a glance; match::strength()
};

/// Proposals, best first, distinct; empty if a fragment has no rim.
///
/// All stretches of 32, 64 and 128 steps of A's rims are laid on all of B's, run backward: places and wall normals, least
/// squares in closed form from running sums.  Stretches that bend much and differ little come first; their poses are settled on
/// everything that then lies together, on both walls, and ranked by how well curvature, bend, torsion and thickness of the
/// rims agree along it.  The best are aligned at a glance on the broken surfaces, whose agreement gives the order.
/// Deterministic for any number of threads.
/// \source leitao 2000, "Initial candidates", carried to curves in space; zhang 2016, section 4.2 (longest boundary)
std::vector<Proposal> propose(const match::Fragment& a, const match::Fragment& b,
                              const ProposeOptions& options, const Context& context);

}  // namespace rejoin::rims
