#include "match/directions.hpp"

#include <algorithm>

namespace rejoin::match {
namespace {

constexpr double kLeastAreaShare = 0.05;  // smaller facets are crumbs of the segmentation

bool any_fracture(const std::vector<mesh::Facet>& facets) {
  return std::any_of(facets.begin(), facets.end(), [](const mesh::Facet& f) { return f.fracture; });
}

/// Without crumbs.
std::vector<int> usable_facets(const std::vector<mesh::Facet>& facets) {
  const bool fracture_only = any_fracture(facets);
  std::vector<int> usable;
  double largest = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (fracture_only && !facets[f].fracture) continue;
    usable.push_back(static_cast<int>(f));
    largest = std::max(largest, facets[f].area);
  }
  std::erase_if(usable,
                [&](int f) { return facets[static_cast<std::size_t>(f)].area < kLeastAreaShare * largest; });
  return usable;
}

}  // namespace

std::vector<CandidateDirection> candidate_directions(const Fragment& fragment,
                                                     const std::vector<glm::dvec3>& given,
                                                     const std::vector<int>& named, int most) {
  std::vector<CandidateDirection> found;
  found.reserve(given.size());
  for (const glm::dvec3& direction : given) found.push_back({glm::normalize(direction), -1});
  if (!found.empty()) return found;

  const std::vector<mesh::Facet>& facets = fragment.facets.facets;
  std::vector<int> usable = named.empty() ? usable_facets(facets) : named;
  std::sort(usable.begin(), usable.end());
  usable.erase(std::unique(usable.begin(), usable.end()), usable.end());
  std::stable_sort(usable.begin(), usable.end(), [&](int f, int g) {
    return facets[static_cast<std::size_t>(f)].roughness > facets[static_cast<std::size_t>(g)].roughness;
  });
  if (named.empty()) usable.resize(std::min(usable.size(), static_cast<std::size_t>(most)));
  for (const int f : usable) found.push_back({facets[static_cast<std::size_t>(f)].normal, f});
  return found;
}

int facet_towards(const Fragment& fragment, const glm::dvec3& direction) {
  const std::vector<mesh::Facet>& facets = fragment.facets.facets;
  const bool fracture_only = any_fracture(facets);
  const glm::dvec3 unit = glm::normalize(direction);
  int best = -1;
  double nearest = -2;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (fracture_only && !facets[f].fracture) continue;
    const double cosine = glm::dot(facets[f].normal, unit);
    if (cosine <= nearest) continue;
    nearest = cosine;
    best = static_cast<int>(f);
  }
  return best;
}

}  // namespace rejoin::match
