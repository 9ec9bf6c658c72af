#include <algorithm>

#include "assembly/grow.hpp"
#include "assembly/pairs.hpp"

namespace rejoin::assembly {

bool Grower::overlap(std::size_t a, std::size_t b, const Rigid& b_to_a) {
  if (!are_near(pieces_[a], pieces_[b], b_to_a, 0.0)) return false;  // most are not: nothing to keep
  std::vector<double> key{static_cast<double>(a), static_cast<double>(b)};
  for (int k = 0; k < 3; ++k) {
    key.insert(key.end(),
               {b_to_a.rotation[k].x, b_to_a.rotation[k].y, b_to_a.rotation[k].z, b_to_a.translation[k]});
  }
  const auto [place, fresh] = overlaps_.try_emplace(std::move(key), false);
  if (fresh) place->second = interpenetrate(pieces_[a], pieces_[b], b_to_a);
  return place->second;
}

/// Whether the two groups of a link can lie as it says.
bool Grower::fits(State& state, std::size_t link) {
  const std::size_t into = state.growth.group[links_[link].a];
  const std::size_t from = state.growth.group[links_[link].b];
  const Rigid from_to_into = transform(state, link, into);
  for (const std::size_t a : state.members[into]) {
    for (const std::size_t b : state.members[from]) {
      const Rigid b_to_a = inverse(state.growth.poses[a]) * from_to_into * state.growth.poses[b];
      if (overlap(a, b, b_to_a)) {
        state.growth.rejected.push_back({link, Rejection::Why::Overlap, a, b});
        return false;
      }
    }
  }
  const auto touching = forbidden_touch(state, link);
  if (touching)
    state.growth.rejected.push_back({link, Rejection::Why::Forbidden, touching->first, touching->second});
  return !touching;
}

/// Two pieces that must not join and would touch if a link put its groups together.  What is near is settled first, as the errors of
/// links add up to more than the distance at which surfaces touch.
std::optional<Grower::Key> Grower::forbidden_touch(const State& state, std::size_t link) const {
  const std::size_t into = state.growth.group[links_[link].a];
  const std::size_t from = state.growth.group[links_[link].b];
  if (into == from) return std::nullopt;
  const Rigid from_to_into = transform(state, link, into);
  std::vector<Key> near;
  for (const Key& pair : unwanted_) {
    const auto [a, b] = pair;
    if (key_of(state.growth.group[a], state.growth.group[b]) != key_of(into, from)) continue;
    const Rigid across = state.growth.group[a] == into ? from_to_into : inverse(from_to_into);
    const Rigid b_to_a = inverse(state.growth.poses[a]) * across * state.growth.poses[b];
    if (touch_forbidden(pieces_[a], pieces_[b], b_to_a)) return pair;
    if (are_near(pieces_[a], pieces_[b], b_to_a, 0.0)) near.push_back(pair);
  }
  if (near.empty()) return std::nullopt;
  State together = state;
  merge(together, link, 0.0);
  Growth& growth = together.growth;
  settle(growth, together.members.at(growth.group[links_[link].a]));
  const auto touching = std::ranges::find_if(near, [&](const Key& pair) {
    const auto [a, b] = pair;
    return touch_forbidden(pieces_[a], pieces_[b], inverse(growth.poses[a]) * growth.poses[b]);
  });
  return touching != near.end() ? std::optional(*touching) : std::nullopt;
}

}  // namespace rejoin::assembly
