#include "shatter/cracks.hpp"

#include <algorithm>
#include <numeric>

#include "core/random.hpp"
#include "mesh/point_index.hpp"
#include "shatter/parts.hpp"

namespace rejoin::shatter {
namespace {

constexpr std::size_t kTries = 200;  // a piece
constexpr double kLinked = 2.2;      // spacings within which points hang together
constexpr double kConnected = 0.98;  // of a piece's points hang together
constexpr double kLeast = 0.15;      // of the mean piece
constexpr double kTightest = 0.6;    // radius of a crack, in reaches of the piece
constexpr double kWidest = 4.0;

/// A crack through a point inside, square to the nearest place of the surface.
Crack crack_through(const glm::dvec3& point, const glm::dvec3& normal, double reach, Random& random) {
  glm::dvec3 across(random.normal(), random.normal(), random.normal());
  across -= glm::dot(across, normal) * normal;
  const double radius = reach * random.uniform(kTightest, kWidest);
  return {point + radius * across / std::max(glm::length(across), 1e-12), radius};
}

}  // namespace

void Cracks::add(std::size_t piece, const Crack& crack) {
  const auto number = static_cast<int>(branches_.size());
  const auto outside = paths_.size();
  branches_.push_back({crack, {~static_cast<int>(piece), ~static_cast<int>(outside)}});
  if (!paths_[piece].empty()) {
    const auto [last, side] = paths_[piece].back();
    branches_[static_cast<std::size_t>(last)].next[static_cast<std::size_t>(side)] = number;
  }
  paths_.push_back(paths_[piece]);
  paths_[piece].emplace_back(number, 0);
  paths_[outside].emplace_back(number, 1);
}

Walls Cracks::walls(const glm::dvec3& point, std::size_t piece) const {
  const glm::dvec3 seen = bent(point);
  Walls result;
  int other_side = 0;
  for (const auto& [number, side] : paths_[piece]) {
    const Branch& branch = branches_[static_cast<std::size_t>(number)];
    const double distance = branch.crack.distance(seen);
    if (result.add(side == 0 ? distance : -distance))
      other_side = branch.next[static_cast<std::size_t>(1 - side)];
  }
  if (!paths_[piece].empty()) result.behind = static_cast<int>(piece_seen_at(seen, other_side));
  return result;
}

std::size_t Cracks::piece_seen_at(const glm::dvec3& bent_point, int next) const {
  if (branches_.empty()) return 0;
  while (next >= 0) {
    const Branch& branch = branches_[static_cast<std::size_t>(next)];
    next = branch.next[branch.crack.distance(bent_point) < 0.0 ? 0 : 1];
  }
  return ~static_cast<std::size_t>(next);
}

std::optional<Cracks> choose_cracks(const Inside& inside, const mesh::Samples& surface,
                                    const glm::dvec3& origin, std::size_t count, const Noise& warp,
                                    std::uint64_t seed, const Context& context) {
  if (inside.points.empty()) return std::nullopt;
  Cracks cracks(warp);
  const Links links = links_within(inside.points, kLinked * inside.spacing);
  const mesh::PointIndex skin(surface.points);
  std::vector<glm::dvec3> bent;
  for (const glm::vec3& point : inside.points) bent.push_back(cracks.bent(origin + glm::dvec3(point)));
  std::vector<std::size_t> label(inside.points.size(), 0);
  Random random(seed, 14);
  const double least = kLeast * static_cast<double>(label.size()) / static_cast<double>(count);
  for (std::size_t tries = 0; cracks.pieces() < count && tries < kTries * count; ++tries) {
    if (context.cancelled()) return std::nullopt;
    context.report(kChoosing, static_cast<double>(cracks.pieces()) / static_cast<double>(count));
    const std::size_t at = random.below(static_cast<std::uint32_t>(label.size()));
    const auto nearest = skin.nearest(inside.points[at]);
    if (!nearest) return std::nullopt;
    double reach = 0.0;
    for (std::size_t i = 0; i < label.size(); ++i) {
      if (label[i] == label[at]) reach = std::max(reach, glm::distance(bent[i], bent[at]));
    }
    const Crack crack = crack_through(bent[at], glm::dvec3(surface.normals[nearest->first]), reach, random);
    std::vector<std::size_t> broken = label;
    for (std::size_t i = 0; i < label.size(); ++i) {
      if (label[i] == label[at] && crack.distance(bent[i]) >= 0.0) broken[i] = cracks.pieces();
    }
    const Parts parts = parts_of(broken, cracks.pieces() + 1, links);
    const auto whole = [&](std::size_t piece) {
      const auto all = static_cast<double>(parts.all[piece]);
      return all >= least && static_cast<double>(parts.largest[piece]) >= kConnected * all;
    };
    if (!whole(label[at]) || !whole(cracks.pieces())) continue;
    cracks.add(label[at], crack);
    label = std::move(broken);
  }
  if (cracks.pieces() < count) return std::nullopt;
  return cracks;
}

}  // namespace rejoin::shatter
