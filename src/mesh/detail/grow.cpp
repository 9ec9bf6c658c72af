#include "mesh/detail/grow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace rejoin::mesh::detail {
namespace {

constexpr float kDegree = 0.017453292F;

struct Grower {
  const std::vector<glm::vec3>& points;
  const std::vector<glm::vec3>& normals;
  const std::vector<Surface>& surface;
  const std::vector<std::vector<std::uint32_t>>& near;
  float cone;
  float step;
  float reach;
  std::vector<int> group;
  std::vector<glm::vec3> sum;  ///< of the normals of each group

  bool adjacent(std::uint32_t i, std::uint32_t k) const {
    return surface[i] == surface[k] && glm::distance(points[i], points[k]) < reach;
  }

  void grow(std::uint32_t seed) {
    const int id = static_cast<int>(sum.size());
    sum.push_back(normals[seed]);
    group[seed] = id;
    std::queue<std::uint32_t> front({seed});
    while (!front.empty()) {
      const auto i = front.front();
      front.pop();
      for (const auto k : near[i]) {
        if (group[k] >= 0 || !adjacent(i, k)) continue;
        if (glm::dot(normals[i], normals[k]) < step) continue;
        if (glm::dot(normals[k], glm::normalize(sum[static_cast<std::size_t>(id)])) < cone) continue;
        group[k] = id;
        sum[static_cast<std::size_t>(id)] += normals[k];
        front.push(k);
      }
    }
  }
};

/// Flattest first: how well the neighbours' normals agree.
std::vector<std::uint32_t> seeds_by_flatness(const Grower& g) {
  std::vector<float> bend(g.points.size(), 0.0F);
  for (std::size_t i = 0; i < bend.size(); ++i) {
    glm::vec3 sum(0.0F);
    for (const auto k : g.near[i]) sum += g.normals[k];
    bend[i] = 1.0F - glm::length(sum) / static_cast<float>(std::max<std::size_t>(1, g.near[i].size()));
  }
  std::vector<std::uint32_t> order(bend.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return bend[a] < bend[b]; });
  return order;
}

/// Gives the members of small groups to the adjacent larger group whose mean normal fits best, until none is
/// left that can go.
void absorb_small(Grower& g, std::size_t smallest) {
  std::vector<std::size_t> size(g.sum.size(), 0);
  for (const int id : g.group) {
    if (id >= 0) ++size[static_cast<std::size_t>(id)];
  }
  for (int round = 0; round < 8; ++round) {
    bool changed = false;
    auto next = g.group;
    for (std::uint32_t i = 0; i < g.group.size(); ++i) {
      const int own = g.group[i];
      if (own >= 0 && size[static_cast<std::size_t>(own)] >= smallest) continue;
      float best = std::cos(70.0F * kDegree);
      for (const auto k : g.near[i]) {
        const int other = g.group[k];
        if (other < 0 || other == own || size[static_cast<std::size_t>(other)] < smallest ||
            !g.adjacent(i, k))
          continue;
        const float fit = glm::dot(g.normals[i], glm::normalize(g.sum[static_cast<std::size_t>(other)]));
        if (fit <= best) continue;
        best = fit;
        next[i] = other;
      }
      changed |= next[i] != own;
    }
    g.group = std::move(next);
    if (!changed) break;
  }
}

}  // namespace

std::vector<std::vector<std::uint32_t>> grow_facets(const std::vector<glm::vec3>& points,
                                                    const std::vector<glm::vec3>& normals,
                                                    const std::vector<Surface>& surface,
                                                    const std::vector<std::vector<std::uint32_t>>& near,
                                                    const GrowOptions& options) {
  Grower g{points,
           normals,
           surface,
           near,
           std::cos(options.cone_deg * kDegree),
           std::cos(options.step_deg * kDegree),
           static_cast<float>(1.8 * options.spacing),
           std::vector<int>(points.size(), -1),
           {}};
  for (const auto seed : seeds_by_flatness(g)) {
    if (g.group[seed] < 0) g.grow(seed);
  }
  absorb_small(g, options.smallest);
  std::vector<std::vector<std::uint32_t>> groups(g.sum.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (g.group[i] >= 0) groups[static_cast<std::size_t>(g.group[i])].push_back(i);
  }
  std::erase_if(groups, [&](const auto& members) { return members.size() < options.smallest; });
  return groups;
}

}  // namespace rejoin::mesh::detail
