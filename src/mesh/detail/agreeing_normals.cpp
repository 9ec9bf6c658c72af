#include "mesh/detail/agreeing_normals.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>
#include <utility>

namespace rejoin::mesh::detail {
namespace {

constexpr float kSure = 0.9F;               // vote that two neighbours agree by without asking others
constexpr std::size_t kPatch = 16;          // points: few, so that an error stays small
constexpr float kMostVariation = 1.0F / 3;  // where points spread in all directions alike

using Points = std::vector<std::uint32_t>;

/// What pairs of neighbours say of each other's normals.
class Votes {
 public:
  Votes(const std::vector<glm::vec3>& points, const std::vector<float>& variation,
        const std::vector<glm::vec3>& normals)
      : points_(points), variation_(variation), normals_(normals) {}

  /// 1: surely they agree as they are, -1: surely when one of them is turned.  On an arc from one point to the other the second normal is the
  /// first one's mirror image, so that opposite normals agree across a wall and around its edge.  Where planes were fitted across
  /// a sharp edge, their normals are alike on both sides of it and say little.
  float of(std::uint32_t i, std::uint32_t k) const {
    const glm::vec3& a = normals_[i];
    const glm::vec3& b = normals_[k];
    const glm::vec3 step = points_[k] - points_[i];
    const float squared = glm::dot(step, step);
    const float bend = squared > 0 ? 2 * glm::dot(a, step) * glm::dot(b, step) / squared : 0.0F;
    const float alike = glm::dot(a, b) - bend;
    return alike * alike * alike * flatness(i, k);
  }

 private:
  float flatness(std::uint32_t i, std::uint32_t k) const {
    if (variation_.empty()) return 1;
    const float flat = std::max(0.0F, 1 - std::max(variation_[i], variation_[k]) / kMostVariation);
    return flat * flat;
  }

  const std::vector<glm::vec3>& points_;
  const std::vector<float>& variation_;
  const std::vector<glm::vec3>& normals_;
};

void turn(const Points& points, std::vector<glm::vec3>& normals) {
  for (const std::uint32_t i : points) normals[i] = -normals[i];
}

/// Neighbours that are sure of each other, few at a time, turned to agree.
std::vector<Points> grow_patches(const NeighbourLists& near, const Votes& votes,
                                 std::vector<glm::vec3>& normals) {
  std::vector<Points> patches;
  std::vector<bool> taken(near.size(), false);
  for (std::uint32_t seed = 0; seed < near.size(); ++seed) {
    if (taken[seed]) continue;
    taken[seed] = true;
    Points patch{seed};
    for (std::size_t at = 0; at < patch.size(); ++at) {
      const std::uint32_t i = patch[at];
      for (const std::uint32_t k : near[i]) {
        const float vote = taken[k] || patch.size() == kPatch ? 0.0F : votes.of(i, k);
        if (std::abs(vote) < kSure) continue;
        if (vote < 0) normals[k] = -normals[k];
        taken[k] = true;
        patch.push_back(k);
      }
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

/// Two patches, of which all pairs of neighbours together vote so clearly.
struct Choice {
  float clearness;
  std::uint32_t a;
  std::uint32_t b;
  bool operator<(const Choice& other) const {
    if (clearness != other.clearness) return clearness < other.clearness;
    return a != other.a ? a > other.a : b > other.b;
  }
};

/// Joins patches until none has a neighbour left.
class Joiner {
 public:
  Joiner(std::vector<Points> patches, std::vector<glm::vec3>& normals)
      : patches_(std::move(patches)), links_(patches_.size()), normals_(normals) {}

  void add_votes(const NeighbourLists& near, const Votes& votes) {
    Points patch_of(near.size());
    for (std::uint32_t p = 0; p < patches_.size(); ++p) {
      for (const std::uint32_t i : patches_[p]) patch_of[i] = p;
    }
    for (std::uint32_t i = 0; i < near.size(); ++i) {
      for (const std::uint32_t k : near[i]) {
        if (patch_of[i] != patch_of[k]) add(patch_of[i], patch_of[k], votes.of(i, k));
      }
    }
  }

  std::vector<Points> join() {
    for (std::uint32_t a = 0; a < links_.size(); ++a) {
      for (const auto& [b, vote] : links_[a]) {
        if (a < b) choose(a, b, vote);
      }
    }
    while (!choices_.empty()) {
      const Choice choice = choices_.top();
      choices_.pop();
      const auto link = links_[choice.a].find(choice.b);
      // A choice is stale when the patches were joined to others since, and voted for anew.
      if (link != links_[choice.a].end() && std::abs(link->second) == choice.clearness)
        unite(choice.a, choice.b, link->second < 0);
    }
    std::erase_if(patches_, [](const Points& patch) { return patch.empty(); });
    return std::move(patches_);
  }

 private:
  using Links = std::unordered_map<std::uint32_t, float>;  // votes, by patch

  void add(std::uint32_t a, std::uint32_t b, float vote) {
    links_[a][b] += vote;
    links_[b][a] += vote;
  }

  void choose(std::uint32_t a, std::uint32_t b, float vote) {
    choices_.push({std::abs(vote), std::min(a, b), std::max(a, b)});
  }

  void unite(std::uint32_t a, std::uint32_t b, bool turned) {
    if (links_[a].size() + patches_[a].size() < links_[b].size() + patches_[b].size()) std::swap(a, b);
    if (turned) turn(patches_[b], normals_);
    patches_[a].insert(patches_[a].end(), patches_[b].begin(), patches_[b].end());
    patches_[b] = {};
    links_[a].erase(b);
    const Links links = std::exchange(links_[b], {});
    for (const auto& [other, vote] : links) {
      if (other == a) continue;
      links_[other].erase(b);
      add(a, other, turned ? -vote : vote);
      choose(a, other, links_[a][other]);
    }
  }

  std::vector<Points> patches_;
  std::vector<Links> links_;
  std::vector<glm::vec3>& normals_;
  std::priority_queue<Choice> choices_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> make_normals_agree(const std::vector<glm::vec3>& points,
                                                           const NeighbourLists& near,
                                                           const std::vector<float>& variation,
                                                           std::vector<glm::vec3>& normals) {
  const Votes votes(points, variation, normals);
  Joiner joiner(grow_patches(near, votes, normals), normals);
  joiner.add_votes(near, votes);
  return joiner.join();
}

}  // namespace rejoin::mesh::detail
