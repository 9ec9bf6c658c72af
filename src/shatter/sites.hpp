/// Where an object breaks.
#pragma once

#include <cstdint>
#include <optional>

#include "core/context.hpp"
#include "mesh/samples.hpp"
#include "shatter/cells.hpp"

namespace rejoin::shatter {

/// Sites for `count` cells, spread evenly over a surface (best of several candidates each), such that every
/// cell's part of the surface is connected as far as possible: the best of several draws.
/// \param samples  of the surface; at least count
/// \param origin   of the samples
/// \param warp     the cells' noise
/// \return nullopt if no draw gives every cell some surface, or the context was cancelled
std::optional<Cells> choose_cells(const mesh::Samples& samples, const glm::dvec3& origin, std::size_t count,
                                  const Noise& warp, std::uint64_t seed, const Context& context);

}  // namespace rejoin::shatter
