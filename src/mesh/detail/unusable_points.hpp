/// Points that scanning software writes for what it could not measure.
#pragma once

#include <string>
#include <vector>

#include "mesh/detail/soup.hpp"

namespace rejoin::mesh::detail {

/// Leaves out points with a coordinate that is NaN, infinite or 1e12 and more, and the faces that use them, with a warning.
/// \pre every corner is the index of a point
/// \throws InputError more than a tenth of the faces, or of a cloud half of the points, would be lost (names the first such vertex)
void leave_out_unusable_points(Soup& soup, const std::string& name, std::vector<std::string>& warnings);

}  // namespace rejoin::mesh::detail
