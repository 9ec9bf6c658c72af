/// What a growth amounts to: which links agree with it, how its pieces settle, and the evidence of all.
#include <algorithm>
#include <numeric>

#include "assembly/grow.hpp"
#include "assembly/pairs.hpp"

namespace rejoin::assembly {

std::size_t Grower::agreeing(const Growth& growth, std::size_t a, std::size_t b) const {
  if (growth.group[a] != growth.group[b]) return links_.size();
  return agreeing(a, b, inverse(growth.poses[a]) * growth.poses[b]);
}

/// Of two pieces that lie so.
std::size_t Grower::agreeing(std::size_t a, std::size_t b, const Rigid& b_to_a) const {
  const auto found = links_of_.find(key_of(a, b));
  if (found == links_of_.end()) return links_.size();
  for (const std::size_t k : found->second) {
    const Link& l = links_[k];
    if (same_pose(pieces_[l.a], pieces_[l.b], l.pose, l.a == a ? b_to_a : inverse(b_to_a), options_))
      return k;
  }
  return links_.size();
}

std::vector<Touching> Grower::contacts_of(const Growth& growth,
                                          const std::vector<std::size_t>& members) const {
  std::vector<Touching> contacts;
  for (std::size_t x = 0; x < members.size(); ++x) {
    for (std::size_t y = x + 1; y < members.size(); ++y) {
      const std::size_t a = members[x];
      const std::size_t b = members[y];
      const Rigid b_to_a = inverse(growth.poses[a]) * growth.poses[b];
      if (std::ranges::find(unwanted_, key_of(a, b)) != unwanted_.end())
        continue;  // not to be pulled together
      const std::size_t link = agreeing(growth, a, b);
      const double least = kContact * std::min(pieces_[a].area(), pieces_[b].area());
      if (link < links_.size()) {
        const bool same = links_[link].a == a;
        contacts.push_back({a, b, same ? links_[link].pose : inverse(links_[link].pose), Known::Searched});
      } else if (touch(pieces_[a], pieces_[b], b_to_a).area > least) {
        contacts.push_back({a, b, b_to_a, Known::Met});
      }
    }
  }
  return contacts;
}

/// Twice, as pieces that come to touch by the first alignment take part in the second.
void Grower::settle(Growth& growth, const std::vector<std::size_t>& members) const {
  std::vector<std::size_t> fixed;
  for (const auto& [piece, pose] : options_.constraints.pinned) {
    if (std::find(members.begin(), members.end(), piece) != members.end()) fixed.push_back(piece);
  }
  for (int round = 0; round < 2; ++round) {
    spread_error(pieces_, members, contacts_of(growth, members), fixed, growth.poses);
  }
}

std::vector<std::size_t> Grower::unsatisfied(const Growth& growth) const {
  std::vector<std::size_t> result;
  for (const auto& [pair, list] : links_of_) {
    if (odds_[list.front()] < log_odds(options_.sure)) continue;
    if (agreeing(growth, pair.first, pair.second) == links_.size()) result.push_back(list.front());
  }
  std::stable_sort(result.begin(), result.end(),
                   [&](std::size_t x, std::size_t y) { return odds_[x] > odds_[y]; });
  return result;
}

std::vector<std::size_t> Grower::parted_by_pins(const Growth& growth) const {
  const auto& pinned = options_.constraints.pinned;
  if (pinned.size() < 2) return {};
  std::vector<std::size_t> held(pieces_.size());  // by links that agree: one of such pieces stands for them
  std::iota(held.begin(), held.end(), std::size_t{0});
  for (const auto& [pair, list] : links_of_) {
    const std::size_t from = held[pair.second];
    const std::size_t to = held[pair.first];
    if (from != to && agreeing(growth, pair.first, pair.second) != links_.size())
      std::ranges::replace(held, from, to);
  }
  std::vector<std::size_t> result = unsatisfied(growth);
  std::erase_if(result, [&](std::size_t link) {
    const auto [a, b] = key_of(links_[link].a, links_[link].b);
    return growth.group[a] != growth.group[b] || held[a] == held[b];
  });
  return result;
}

void Grower::sum_up(Growth& growth) const {
  const std::set<std::size_t> used(growth.used.begin(), growth.used.end());
  growth.evidence = growth.vouched;
  for (const auto& [pair, list] : links_of_) {
    if (growth.group[pair.first] != growth.group[pair.second]) continue;
    const std::size_t link = agreeing(growth, pair.first, pair.second);
    if (link < links_.size()) {
      growth.evidence +=
          used.count(link) != 0 ? odds_[link] : std::max(0.0, odds_[link] + options_.loop_weight);
    } else if (odds_[list.front()] >= log_odds(options_.sure)) {
      growth.evidence -= odds_[list.front()];
    }
  }
}

/// Strong links that were never tried because others contradict them.
void Grower::tell_contradictions(State& state) const {
  for (const auto& [key, list] : state.proposals) {
    for (const Proposal& p : list) {
      if (p.against == links_.size() || odds_[p.link] < log_odds(options_.sure)) continue;
      const Link& against = links_[p.against];
      state.growth.rejected.push_back({p.link, Rejection::Why::Contradiction, against.a, against.b});
    }
  }
}

}  // namespace rejoin::assembly
