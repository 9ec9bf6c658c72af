#include "shatter/sites.hpp"

#include <algorithm>

#include "core/random.hpp"
#include "shatter/parts.hpp"

namespace rejoin::shatter {
namespace {

constexpr int kDraws = 24;
constexpr int kCandidates = 6;
constexpr double kBeside = 1.9;  // spacings within which samples are neighbours

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

}  // namespace

std::optional<Cells> choose_cells(const mesh::Samples& samples, const glm::dvec3& origin, std::size_t count,
                                  const Noise& warp, std::uint64_t seed, const Context& context) {
  const Links links = links_within(samples.points, kBeside * samples.spacing);
  std::optional<Cells> best;
  std::size_t least_lost = samples.size();
  std::vector<glm::dvec3> bent;
  for (const glm::vec3& sample : samples.points) {
    const glm::dvec3 point = origin + glm::dvec3(sample);
    bent.push_back(point + warp.at(point));
  }
  Random random(seed, 11);
  for (int draw = 0; draw < kDraws && least_lost > 0; ++draw) {
    if (context.cancelled()) return std::nullopt;
    context.report(kChoosing, static_cast<double>(draw) / kDraws);
    Cells cells(spread_sites(samples, origin, count, random), warp);
    std::vector<std::size_t> label;
    label.reserve(bent.size());
    for (const glm::dvec3& point : bent) label.push_back(cells.piece_seen_at(point));
    const Parts parts = parts_of(label, count, links);
    if (*std::min_element(parts.largest.begin(), parts.largest.end()) == 0) continue;
    std::size_t lost = 0;
    for (std::size_t k = 0; k < count; ++k) lost += parts.all[k] - parts.largest[k];
    if (lost >= least_lost) continue;
    least_lost = lost;
    best = std::move(cells);
  }
  return best;
}

}  // namespace rejoin::shatter
