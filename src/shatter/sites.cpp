#include "shatter/sites.hpp"

#include <algorithm>

#include "core/random.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::shatter {
namespace {

constexpr int kDraws = 24;
constexpr int kCandidates = 6;
constexpr double kLinked = 1.9;  // spacings within which samples are neighbours

/// Mitchell's best candidate: each site is the farthest from the others of a few random points.
std::vector<glm::dvec3> spread_sites(const mesh::Samples& samples, const glm::dvec3& origin,
                                     std::size_t count, Random& random) {
  std::vector<glm::dvec3> sites;
  while (sites.size() < count) {
    glm::dvec3 best(0.0);
    double farthest = -1.0;
    for (int k = 0; k < kCandidates; ++k) {
      const glm::dvec3 point =
          origin + glm::dvec3(samples.points[random.below(static_cast<std::uint32_t>(samples.size()))]);
      double distance = 1e300;
      for (const glm::dvec3& site : sites) distance = std::min(distance, glm::distance(site, point));
      if (distance <= farthest) continue;
      farthest = distance;
      best = point;
    }
    sites.push_back(best);
  }
  return sites;
}

std::vector<std::vector<std::uint32_t>> neighbours_of(const mesh::Samples& samples) {
  const mesh::PointIndex index(samples.points);
  std::vector<std::vector<std::uint32_t>> result(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    index.within(samples.points[i], static_cast<float>(kLinked * samples.spacing), result[i]);
  }
  return result;
}

/// For every label the number of samples in its largest connected part and in all.
struct Parts {
  std::vector<std::size_t> largest, all;
};

Parts parts_of(const std::vector<std::size_t>& label, std::size_t labels,
               const std::vector<std::vector<std::uint32_t>>& neighbours) {
  Parts parts{std::vector<std::size_t>(labels, 0), std::vector<std::size_t>(labels, 0)};
  std::vector<char> seen(label.size(), 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t start = 0; start < label.size(); ++start) {
    if (seen[start] != 0) continue;
    std::size_t count = 0;
    stack.assign(1, start);
    seen[start] = 1;
    while (!stack.empty()) {
      const std::uint32_t i = stack.back();
      stack.pop_back();
      ++count;
      for (const std::uint32_t k : neighbours[i]) {
        if (seen[k] != 0 || label[k] != label[i]) continue;
        seen[k] = 1;
        stack.push_back(k);
      }
    }
    parts.all[label[start]] += count;
    parts.largest[label[start]] = std::max(parts.largest[label[start]], count);
  }
  return parts;
}

}  // namespace

Cells choose_cells(const mesh::Samples& samples, const glm::dvec3& origin, std::size_t count,
                   const Noise& warp, std::uint64_t seed) {
  const auto neighbours = neighbours_of(samples);
  Cells best{{}, warp};
  std::size_t least_lost = samples.size();
  std::vector<glm::dvec3> bent(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    bent[i] = best.bent(origin + glm::dvec3(samples.points[i]));
  Random random(seed, 11);
  for (int draw = 0; draw < kDraws && least_lost > 0; ++draw) {
    const Cells cells{spread_sites(samples, origin, count, random), warp};
    std::vector<std::size_t> label(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) label[i] = cells.cell_of(bent[i]);
    const Parts parts = parts_of(label, count, neighbours);
    if (*std::min_element(parts.largest.begin(), parts.largest.end()) == 0) continue;
    std::size_t lost = 0;
    for (std::size_t k = 0; k < count; ++k) lost += parts.all[k] - parts.largest[k];
    if (lost >= least_lost) continue;
    least_lost = lost;
    best = cells;
  }
  return best;
}

}  // namespace rejoin::shatter
