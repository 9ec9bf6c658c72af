#include "shatter/cells.hpp"

namespace rejoin::shatter {

Cells::Walls Cells::walls(const glm::dvec3& point, std::size_t cell) const {
  const glm::dvec3 seen = bent(point);
  const glm::dvec3 own = sites[cell];
  Walls result;
  for (std::size_t other = 0; other < sites.size(); ++other) {
    if (other == cell) continue;
    const glm::dvec3 across = sites[other] - own;
    const double distance = glm::dot(seen - 0.5 * (own + sites[other]), across) / glm::length(across);
    if (distance > result.nearest) {
      result.second = result.nearest;
      result.nearest = distance;
      result.behind = static_cast<int>(other);
    } else if (distance > result.second) {
      result.second = distance;
    }
  }
  return result;
}

std::size_t Cells::cell_of(const glm::dvec3& bent_point) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < sites.size(); ++k) {
    if (glm::distance(bent_point, sites[k]) < glm::distance(bent_point, sites[best])) best = k;
  }
  return best;
}

}  // namespace rejoin::shatter
