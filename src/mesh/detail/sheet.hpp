/// A surface that grows triangle by triangle and stays manifold.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace rejoin::mesh::detail {

/// Takes triangles over given points as long as every edge keeps at most one face on each side, wound alike,
/// and faces around a point do not overlap.
class Sheet {
 public:
  /// \param points  kept by reference   \param axes  per point the direction to look along, unit; kept by
  /// reference
  Sheet(const std::vector<glm::vec3>& points, const std::vector<glm::vec3>& axes);

  /// Adds the triangle if it fits; says whether it did.
  bool add(const glm::uvec3& triangle);

  /// Adds a triangle that closes a gap between faces: may overlap a little, where overlaps kept the gap open.
  bool close(const glm::uvec3& triangle);

  /// Whether a face has the edge in this direction.
  bool has_edge(std::uint32_t from, std::uint32_t to) const;

  /// Where the boundary goes on from a point: ends of edges that have a face on one side only, in the direction that a face on
  /// the other side would have.
  void open_edges(std::uint32_t from, std::vector<std::uint32_t>& ends) const;

  const std::vector<glm::uvec3>& faces() const { return faces_; }

 private:
  bool fits(const glm::uvec3& triangle) const;
  void insert(const glm::uvec3& triangle);
  bool folds(const glm::uvec3& triangle) const;
  bool overlaps(const glm::uvec3& triangle, int corner) const;
  glm::vec3 cross_of(const glm::uvec3& triangle) const;

  const std::vector<glm::vec3>& points_;
  const std::vector<glm::vec3>& axes_;
  std::vector<glm::uvec3> faces_;
  std::vector<std::vector<std::uint32_t>> around_;  ///< faces at every point
};

}  // namespace rejoin::mesh::detail
