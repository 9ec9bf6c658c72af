#include "shatter/cells.hpp"

namespace rejoin::shatter {

Walls Cells::walls(const glm::dvec3& point, std::size_t piece) const {
  const glm::dvec3 seen = point + warp_.at(point);
  const glm::dvec3 own = sites_[piece];
  Walls result;
  for (std::size_t other = 0; other < sites_.size(); ++other) {
    if (other == piece) continue;
    const glm::dvec3 across = sites_[other] - own;
    const double distance = glm::dot(seen - 0.5 * (own + sites_[other]), across) / glm::length(across);
    if (result.add(distance)) result.behind = static_cast<int>(other);
  }
  return result;
}

std::size_t Cells::piece_seen_at(const glm::dvec3& bent) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < sites_.size(); ++k) {
    if (glm::distance(bent, sites_[k]) < glm::distance(bent, sites_[best])) best = k;
  }
  return best;
}

}  // namespace rejoin::shatter
