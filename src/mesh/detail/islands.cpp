#include "mesh/detail/islands.hpp"

#include <glm/glm.hpp>
#include <numbers>
#include <utility>

#include "core/components.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr float kOwnWay = 0.34F;    // cosine from the mean normal: 70 degrees
constexpr double kRoundish = 0.57;  // a disc has 1, a strip three times as long as wide 0.57

using Samples = std::vector<std::uint32_t>;

/// Broken samples that hang together.
std::vector<Samples> broken_parts(const Ground& ground) {
  Components components(ground.points.size());
  for (std::uint32_t i = 0; i < ground.points.size(); ++i) {
    if (ground.surface[i] != Surface::Fracture) continue;
    for (const auto k : ground.near[i]) {
      if (ground.adjacent(i, k)) components.unite(i, k);
    }
  }
  std::vector<Samples> parts(ground.points.size());
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    if (ground.surface[i] == Surface::Fracture) parts[components.of(i)].push_back(i);
  }
  return parts;
}

/// Area over that of the disc that spreads as far.
double roundness(const Ground& ground, double sample_area, const Samples& part) {
  glm::dvec3 centre(0.0);
  for (const auto i : part) centre += glm::dvec3(ground.points[i]);
  centre /= static_cast<double>(part.size());
  double squares = 0;
  for (const auto i : part) {
    const glm::dvec3 d = glm::dvec3(ground.points[i]) - centre;
    squares += glm::dot(d, d);
  }
  const auto count = static_cast<double>(part.size());
  return count * count * sample_area / (2 * std::numbers::pi * squares);
}

Samples looking_its_way(const Ground& ground, const Samples& part) {
  glm::vec3 sum(0.0F);
  for (const auto i : part) sum += ground.normals[i];
  const float least = kOwnWay * glm::length(sum);
  Samples facet;
  for (const auto i : part) {
    if (glm::dot(ground.normals[i], sum) > least) facet.push_back(i);
  }
  return facet;
}

}  // namespace

void add_islands(const Ground& ground, double sample_area, std::size_t smallest,
                 std::vector<Samples>& facets) {
  std::vector<bool> taken(ground.points.size(), false);
  for (const Samples& facet : facets) {
    for (const auto i : facet) taken[i] = true;
  }
  for (const Samples& part : broken_parts(ground)) {
    if (part.size() < smallest || roundness(ground, sample_area, part) < kRoundish) continue;
    bool whole = true;
    for (const auto i : part) whole = whole && !taken[i];
    if (!whole) continue;
    if (Samples facet = looking_its_way(ground, part); facet.size() >= smallest)
      facets.push_back(std::move(facet));
  }
}

}  // namespace rejoin::mesh::detail
