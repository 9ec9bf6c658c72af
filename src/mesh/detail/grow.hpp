/// Facets by region growing over samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/facets.hpp"

namespace rejoin::mesh::detail {

/// Degrees between a facet's mean normal and its others.
inline constexpr float kCone = 35.0F;

/// The samples that facets grow over.
struct Ground {
  const std::vector<glm::vec3>& points;
  const std::vector<glm::vec3>& normals;
  const std::vector<Surface>& surface;
  const std::vector<std::vector<std::uint32_t>>& near;  ///< of each sample, those within about two spacings
  double spacing;                                       ///< of the samples, mesh units

  /// Whether two near samples may lie in one group: of one class, and next to each other.
  bool adjacent(std::uint32_t i, std::uint32_t k) const;
};

/// Groups of samples, numbered from 0.  No group mixes classes.
struct Groups {
  std::vector<int> of_sample;
  std::vector<glm::vec3> sum;  ///< of each group's normals

  std::vector<std::size_t> sizes() const;              ///< samples of each group
  std::vector<bool> at_least(std::size_t size) const;  ///< true for the groups of so many samples or more
};

/// Grows groups one by one, from the flattest places on, until each sample is in one.
/// \param cone_deg  normals of a group stay within this angle of its mean
Groups grow(const Ground& ground, float cone_deg);

/// Gives the samples of the groups that do not stay to the adjacent ones whose mean normal fits best, until none is left that
/// can go or after eight rounds.
void absorb(const Ground& ground, Groups& groups, const std::vector<bool>& stays);

/// Samples of each group that has at least `smallest`.
std::vector<std::vector<std::uint32_t>> members_of(const Groups& groups, std::size_t smallest);

/// Samples of facets that end where the surface has bent by `cone_deg`.
/// \param smallest  smaller facets go to the neighbour they fit best
std::vector<std::vector<std::uint32_t>> grow_facets(const Ground& ground, float cone_deg,
                                                    std::size_t smallest);

}  // namespace rejoin::mesh::detail
