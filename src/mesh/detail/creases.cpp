#include "mesh/detail/creases.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

#include "core/angle.hpp"
#include "core/components.hpp"
#include "mesh/neighbours.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr float kSmallCone_deg = 20.0F;  // of the groups that facets are put together from
constexpr std::size_t kCrumb = 6;        // samples: smaller groups are noise
constexpr double kBeside = 2.5;   // spacings from one side of a border to the other: past an edge's rounding
constexpr double kBeyond = 4.0;   // and no further
constexpr float kBehind = -0.5F;  // cosine of normals from which one sample lies behind the other
constexpr double kLeastPairs = 4.0;         // of samples by which a border is known
constexpr double kCrease = 15.0 * kDegree;  // mean bend from which a border is a crease
constexpr double kCap = 30.0 * kDegree;  // half angle of the cap whose normals spread as far as a facet's may
constexpr std::size_t kInside = 5;       // a facet has one sample away from its border in so many

/// How the surface bends from one group to another.
struct Border {
  double bend = 0;   // sum over the pairs, radians; convex > 0
  double pairs = 0;  // of samples, one on each side

  double mean() const { return std::abs(bend) / pairs; }
  void add(const Border& other) {
    bend += other.bend;
    pairs += other.pairs;
  }
};

double angle_between(const glm::vec3& a, const glm::vec3& b) {
  return std::acos(std::clamp(static_cast<double>(glm::dot(a, b)), -1.0, 1.0));
}

/// Makes one of groups that meet smoothly, those first that are most alike.
class Merger {
 public:
  Merger(const Ground& ground, Groups& groups)
      : groups_(groups), sizes_(groups.sizes()), merges_(sizes_.size(), 0), borders_(sizes_.size()) {
    find_borders(ground);
  }

  void run() {
    for (std::size_t x = 0; x < borders_.size(); ++x) offer_all(x);
    Components merged(sizes_.size());
    while (!offers_.empty()) {
      const Offer best = offers_.top();
      offers_.pop();
      if (best.merges != merges_[best.x] + merges_[best.y] || sizes_[best.x] == 0 || sizes_[best.y] == 0)
        continue;
      merge(best.x, best.y);
      merged.unite(static_cast<std::uint32_t>(best.x), static_cast<std::uint32_t>(best.y));
      offer_all(best.x);
    }
    for (int& id : groups_.of_sample) id = static_cast<int>(merged.of(static_cast<std::uint32_t>(id)));
  }

 private:
  struct Offer {
    double cost;
    std::size_t x;  // < y
    std::size_t y;
    std::size_t merges;  // of both, when the offer was made

    bool operator<(const Offer& other) const {  // the cheapest is the top of a queue
      return std::tie(other.cost, other.x, other.y) < std::tie(cost, x, y);
    }
  };

  void find_borders(const Ground& ground) {
    const Neighbours neighbours(ground.points, static_cast<float>(kBeyond * ground.spacing));
    const auto beside = static_cast<float>(kBeside * ground.spacing);
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < ground.points.size(); ++i) {
      neighbours.of(ground.points[i], near);
      for (const auto k : near) {
        if (k <= i || groups_.of_sample[k] == groups_.of_sample[i] || ground.surface[k] != ground.surface[i])
          continue;
        const glm::vec3 between = ground.points[k] - ground.points[i];
        if (glm::length(between) < beside || glm::dot(ground.normals[i], ground.normals[k]) < kBehind)
          continue;
        const double angle = angle_between(ground.normals[i], ground.normals[k]);
        const bool convex = glm::dot(between, ground.normals[k] - ground.normals[i]) > 0.0F;
        const auto x = static_cast<std::size_t>(groups_.of_sample[i]);
        const auto y = static_cast<std::size_t>(groups_.of_sample[k]);
        const Border pair{convex ? angle : -angle, 1.0};
        borders_[x][y].add(pair);
        borders_[y][x].add(pair);
      }
    }
  }

  void offer_all(std::size_t x) {
    for (const auto& [y, border] : borders_[x]) {
      if (border.pairs < kLeastPairs || border.mean() > kCrease) continue;
      const auto size = static_cast<double>(sizes_[x] + sizes_[y]);
      const double spread = 1.0 - static_cast<double>(glm::length(groups_.sum[x] + groups_.sum[y])) / size;
      if (spread > 0.5 * (1.0 - std::cos(kCap))) continue;
      const double turn = angle_between(glm::normalize(groups_.sum[x]), glm::normalize(groups_.sum[y]));
      offers_.push({border.mean() + turn, std::min(x, y), std::max(x, y), merges_[x] + merges_[y]});
    }
  }

  /// x becomes both.
  void merge(std::size_t x, std::size_t y) {
    groups_.sum[x] += groups_.sum[y];
    sizes_[x] += sizes_[y];
    sizes_[y] = 0;
    merges_[x] += 1 + merges_[y];
    const auto borders_of_y = std::move(borders_[y]);
    borders_[y].clear();
    for (const auto& [z, border] : borders_of_y) {
      borders_[z].erase(y);
      if (z == x) continue;
      borders_[x][z].add(border);
      borders_[z][x].add(border);
    }
  }

  Groups& groups_;
  std::vector<std::size_t> sizes_;                      // 0: merged into another
  std::vector<std::size_t> merges_;                     // that made each group
  std::vector<std::map<std::size_t, Border>> borders_;  // of each group, by the other group
  std::priority_queue<Offer> offers_;
};

/// Groups that are large enough and have an inside.
std::vector<bool> broad(const Ground& ground, const Groups& groups, std::size_t smallest) {
  std::vector<std::size_t> inside(groups.sum.size(), 0);
  for (std::size_t i = 0; i < groups.of_sample.size(); ++i) {
    const int own = groups.of_sample[i];
    const auto& near = ground.near[i];
    if (std::all_of(near.begin(), near.end(), [&](auto k) { return groups.of_sample[k] == own; }))
      ++inside[static_cast<std::size_t>(own)];
  }
  const std::vector<std::size_t> sizes = groups.sizes();
  std::vector<bool> result;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    result.push_back(sizes[k] >= smallest && kInside * inside[k] >= sizes[k]);
  return result;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> facets_between_creases(const Ground& ground, std::size_t smallest) {
  Groups groups = grow(ground, kSmallCone_deg);
  absorb(ground, groups, groups.at_least(kCrumb));
  Merger(ground, groups).run();
  absorb(ground, groups, broad(ground, groups, smallest));
  return members_of(groups, smallest);
}

}  // namespace rejoin::mesh::detail
