/// Facets that end at creases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/detail/grow.hpp"

namespace rejoin::mesh::detail {

/// Samples of facets that end where the surface bends sharply, however little or much it has bent before: small groups that
/// meet without a crease are one facet, as long as its normals spread no further than those of a cap of 30 degrees.  Rounded
/// edges, which are groups without an inside, go to the facets beside them.
/// \param smallest  smaller facets go to the neighbour they fit best
std::vector<std::vector<std::uint32_t>> facets_between_creases(const Ground& ground, std::size_t smallest);

}  // namespace rejoin::mesh::detail
