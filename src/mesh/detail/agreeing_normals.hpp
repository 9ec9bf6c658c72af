/// Which of its two directions every normal of a cloud gets.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/detail/neighbour_lists.hpp"

namespace rejoin::mesh::detail {

/// Turns normals of a surface to agree with their neighbours'.  Patches of a few points that are sure of each other are joined two by
/// two, those first whose neighbours taken together say most clearly whether one of them is to be turned: one pair of neighbours that
/// errs, as some do around the edges of a wall that is hardly thicker than its points lie apart, is outvoted.  Deterministic.
/// \param near       of the points
/// \param variation  of the planes that the normals are of (PlaneFit), each 0 .. 1/3; empty: they are none of planes
/// \param normals    unit
/// \return the points of every part that hangs together: within it normals agree, as a whole it may still have to be turned
/// \source Koenig and Gumhold 2009 (what agrees: the normal at the other end of a circular arc); Keuper et al. 2015 (greedy additive
///         edge contraction)
std::vector<std::vector<std::uint32_t>> make_normals_agree(const std::vector<glm::vec3>& points,
                                                           const NeighbourLists& near,
                                                           const std::vector<float>& variation,
                                                           std::vector<glm::vec3>& normals);

}  // namespace rejoin::mesh::detail
