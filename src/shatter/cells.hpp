/// Pieces around sites.
#pragma once

#include <vector>

#include "shatter/division.hpp"
#include "shatter/noise.hpp"

namespace rejoin::shatter {

/// Voronoi cells with rough walls: the planes between the sites, bent by noise.
class Cells final : public Division {
 public:
  /// \param sites  one a piece, at least one
  Cells(std::vector<glm::dvec3> sites, const Noise& warp) : sites_(std::move(sites)), warp_(warp) {}

  std::size_t pieces() const override { return sites_.size(); }
  Walls walls(const glm::dvec3& point, std::size_t piece) const override;
  std::size_t piece_of(const glm::dvec3& point) const override {
    return piece_seen_at(point + warp_.at(point));
  }

  /// The same for a point that is bent already.
  std::size_t piece_seen_at(const glm::dvec3& bent) const;

 private:
  std::vector<glm::dvec3> sites_;
  Noise warp_;
};

}  // namespace rejoin::shatter
