#include "mesh/detail/flanks.hpp"

#include <algorithm>
#include <glm/glm.hpp>

#include "core/median.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr double kThinnest = 0.5;  // of the wall
constexpr double kThickest = 1.8;
constexpr float kLean = 0.85F;    // cosine of the flank's on the skin around it
constexpr float kAlike = 0.75F;   // cosine within which others look about as the skin does:
constexpr double kAround = 0.8;   // so much of what lies around,
constexpr double kOfSkin = 0.95;  // and of the skin among it

}  // namespace

void take_flanks_for_walls(Segmentation& s, const std::vector<std::vector<std::uint32_t>>& facets,
                           const std::vector<float>& thickness, const Lists& near) {
  std::vector<int> facet_of(s.samples.size(), -1);
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (const auto i : facets[f]) facet_of[i] = static_cast<int>(f);

  const auto is_flank = [&](const std::vector<std::uint32_t>& facet) {
    glm::vec3 own(0.0F);
    glm::vec3 skin(0.0F);
    std::vector<float> through;
    std::vector<std::uint32_t> around;
    for (const auto i : facet) {
      own += s.normals[i];
      through.push_back(thickness[i]);
      for (const auto k : near[i]) {
        if (facet_of[k] == facet_of[i]) continue;
        around.push_back(k);
        if (s.surface[k] == Surface::Original) skin += s.normals[k];
      }
    }
    const double middle = static_cast<double>(median(through)) / s.wall_thickness;
    if (middle < kThinnest || middle > kThickest || glm::length(skin) == 0.0F) return false;
    skin = glm::normalize(skin);
    if (glm::dot(glm::normalize(own), skin) < kLean) return false;
    const auto is_skin = [&](std::uint32_t k) { return s.surface[k] == Surface::Original; };
    const auto looks_alike = [&](std::uint32_t k) { return glm::dot(s.normals[k], skin) > kAlike; };
    const auto count = [&](const auto& which) {
      return static_cast<double>(std::ranges::count_if(around, which));
    };
    return count(looks_alike) > kAround * static_cast<double>(around.size()) &&
           count([&](std::uint32_t k) { return is_skin(k) && looks_alike(k); }) > kOfSkin * count(is_skin);
  };

  std::vector<std::size_t> flanks;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (s.surface[facets[f].front()] == Surface::Fracture && is_flank(facets[f])) flanks.push_back(f);
  }
  for (const std::size_t f : flanks)
    for (const auto i : facets[f]) s.surface[i] = Surface::Original;
}

}  // namespace rejoin::mesh::detail
