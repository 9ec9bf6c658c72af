/// How far apart the fragments of an assembly stand, for colouring.
#pragma once

#include <vector>

#include "core/context.hpp"
#include "core/rigid.hpp"
#include "mesh/mesh.hpp"

namespace rejoin::report {

/// A fragment at its place.
struct PlacedSurface {
  const mesh::Mesh* mesh = nullptr;  ///< not owned; with faces
  Rigid pose;                        ///< file coordinates -> common frame
  int group = 0;                     ///< only fragments of one group are compared
};

/// Signed gaps from every vertex to the nearest surface of the same group that faces it within `reach`; NaN where there
/// is none.  Of several, the one of least size counts.
/// \param reach  mesh units, > 0
/// \return one list a surface, one entry a vertex; shorter if it was cancelled
std::vector<std::vector<float>> assembly_gaps(const std::vector<PlacedSurface>& surfaces, double reach,
                                              const Context& context);

/// The |gap| that the strongest colours stand for: kMedianGaps, rounded up.
/// \param gaps   of all surfaces, as assembly_gaps() gives them
/// \param reach  with which; the scale is half of that at most, and where there is no gap
/// \return mesh units, > 0
double gap_scale(const std::vector<std::vector<float>>& gaps, double reach);

}  // namespace rejoin::report
