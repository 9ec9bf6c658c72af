/// A block cut by a wavy surface: two fragments whose pose is known.
#pragma once

#include "core/rigid.hpp"
#include "match/match.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::report {

/// A box of 2 x 1 x 0.6 (x, y, z) whose top is a wavy surface about z = 0, on an n x n/2 grid; closed,
/// sharing vertices.
/// \param upper  the part above the cut instead of the one below it
mesh::Mesh wavy_block(int n, bool upper);

/// A lies under the cut, B above it; B's file coordinates are turned and moved.
struct Planted {
  match::Fragment a;
  match::Fragment b;
  Rigid pose;  ///< B's file coordinates -> A's
};
Planted planted_pair(int n = 40);

/// A sphere of the given radius about the origin.
mesh::Mesh ball(float radius, int rings);

}  // namespace rejoin::report
