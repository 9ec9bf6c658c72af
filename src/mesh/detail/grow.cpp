#include "mesh/detail/grow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "core/angle.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr float kFloatDegree = static_cast<float>(kDegree);
constexpr float kStep = 30.0F * kFloatDegree;  // neighbours across a group differ by less than this
constexpr float kFitting =
    70.0F * kFloatDegree;       // what a group absorbs differs from its mean by less than this
constexpr double kReach = 1.8;  // spacings between adjacent samples, at most

void grow_from(std::uint32_t seed, const Ground& ground, float cone, Groups& groups) {
  const float step = std::cos(kStep);
  const int id = static_cast<int>(groups.sum.size());
  glm::vec3& sum = groups.sum.emplace_back(ground.normals[seed]);
  groups.of_sample[seed] = id;
  std::queue<std::uint32_t> front({seed});
  while (!front.empty()) {
    const auto i = front.front();
    front.pop();
    for (const auto k : ground.near[i]) {
      if (groups.of_sample[k] >= 0 || !ground.adjacent(i, k)) continue;
      if (glm::dot(ground.normals[i], ground.normals[k]) < step) continue;
      if (glm::dot(ground.normals[k], glm::normalize(sum)) < cone) continue;
      groups.of_sample[k] = id;
      sum += ground.normals[k];
      front.push(k);
    }
  }
}

/// Flattest first: how well the neighbours' normals agree.
std::vector<std::uint32_t> seeds_by_flatness(const Ground& ground) {
  std::vector<float> bend(ground.points.size(), 0.0F);
  for (std::size_t i = 0; i < bend.size(); ++i) {
    const auto& near = ground.near[i];
    glm::vec3 sum(0.0F);
    for (const auto k : near) sum += ground.normals[k];
    bend[i] = 1.0F - glm::length(sum) / static_cast<float>(std::max<std::size_t>(1, near.size()));
  }
  std::vector<std::uint32_t> order(bend.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return bend[a] < bend[b]; });
  return order;
}

}  // namespace

bool Ground::adjacent(std::uint32_t i, std::uint32_t k) const {
  return surface[i] == surface[k] &&
         glm::distance(points[i], points[k]) < static_cast<float>(kReach * spacing);
}

std::vector<std::size_t> Groups::sizes() const {
  std::vector<std::size_t> sizes(sum.size(), 0);
  for (const int id : of_sample) ++sizes[static_cast<std::size_t>(id)];
  return sizes;
}

std::vector<bool> Groups::at_least(std::size_t size) const {
  std::vector<bool> result;
  for (const std::size_t samples : sizes()) result.push_back(samples >= size);
  return result;
}

Groups grow(const Ground& ground, float cone_deg) {
  Groups groups{std::vector<int>(ground.points.size(), -1), {}};
  const float cone = std::cos(cone_deg * kFloatDegree);
  for (const auto seed : seeds_by_flatness(ground)) {
    if (groups.of_sample[seed] < 0) grow_from(seed, ground, cone, groups);
  }
  return groups;
}

void absorb(const Ground& ground, Groups& groups, const std::vector<bool>& stays) {
  for (int round = 0; round < 8; ++round) {
    bool changed = false;
    auto next = groups.of_sample;
    for (std::uint32_t i = 0; i < next.size(); ++i) {
      const int own = groups.of_sample[i];
      if (stays[static_cast<std::size_t>(own)]) continue;
      float best = std::cos(kFitting);
      for (const auto k : ground.near[i]) {
        const int other = groups.of_sample[k];
        if (!stays[static_cast<std::size_t>(other)] || !ground.adjacent(i, k)) continue;
        const glm::vec3 mean = glm::normalize(groups.sum[static_cast<std::size_t>(other)]);
        const float fit = glm::dot(ground.normals[i], mean);
        if (fit <= best) continue;
        best = fit;
        next[i] = other;
      }
      changed |= next[i] != own;
    }
    groups.of_sample = std::move(next);
    if (!changed) break;
  }
  std::fill(groups.sum.begin(), groups.sum.end(), glm::vec3(0.0F));
  for (std::size_t i = 0; i < groups.of_sample.size(); ++i)
    groups.sum[static_cast<std::size_t>(groups.of_sample[i])] += ground.normals[i];
}

std::vector<std::vector<std::uint32_t>> members_of(const Groups& groups, std::size_t smallest) {
  std::vector<std::vector<std::uint32_t>> members(groups.sum.size());
  for (std::uint32_t i = 0; i < groups.of_sample.size(); ++i)
    members[static_cast<std::size_t>(groups.of_sample[i])].push_back(i);
  std::erase_if(members, [&](const auto& samples) { return samples.size() < smallest; });
  return members;
}

std::vector<std::vector<std::uint32_t>> grow_facets(const Ground& ground, float cone_deg,
                                                    std::size_t smallest) {
  Groups groups = grow(ground, cone_deg);
  absorb(ground, groups, groups.at_least(smallest));
  return members_of(groups, smallest);
}

}  // namespace rejoin::mesh::detail
