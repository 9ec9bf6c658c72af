#include "outline/assembly.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "core/parallel.hpp"
#include "outline/congruence.hpp"
#include "outline/detail/copies.hpp"
#include "outline/detail/links.hpp"
#include "outline/detail/rivals.hpp"
#include "outline/layout.hpp"
#include "outline/shared_border.hpp"

namespace rejoin::outline {
namespace {

using detail::kSameShift;
using detail::kSameTurn;
using detail::Link;
using detail::LinkedPieces;

// What holds a part of a group to the rest, nats.
constexpr double kLeastJoin = 2.0;
// Share of the tolerance below which borders' reach is not shortened further.
constexpr double kLeastReach = 0.2;
// Score of a join that is not given up for a better fit of the whole.
constexpr double kLikelyJoin = 0.3;
// Of the contacts' information, beside the candidates' evidence, which knows most of it.
constexpr double kOfContacts = 0.3;
// Pieces that share less than this, or face each other over less, only touch, as corners do; steps.
constexpr double kShortestJoin = 8.0;

/// All links between two groups that move the second in about the same way.
struct Bundle {
  std::size_t first = 0;
  std::size_t second = 0;
  Planar moved;              // second -> first
  double evidence = 0.0;     // of the links, at most once a pair
  double information = 0.0;  // of the contacts, nats
  std::size_t seed = 0;      // the link that it is made around
  std::size_t sure = 0;      // pairs of pieces with a sure link

  /// Whatever lies along the other touches it, so contacts say no more than the search does.
  double strength() const { return evidence + std::min(evidence, kOfContacts * information); }
};

/// The most that one of two pieces' links in a bundle tells.
struct Told {
  double evidence = 0.0;
  double information = 0.0;
};

class Assembler {
 public:
  Assembler(const LinkedPieces& pieces, const AssemblyOptions& options)
      : pieces_(pieces),
        shapes_(pieces.shapes),
        links_(pieces.links),
        tolerance_(pieces.tolerance),
        options_(options),
        layout_(pieces.shapes, pieces.tolerance) {}

  Layout run(const Context& context) {
    grow(context);
    // Each round must make the whole fit better, so this ends; the number is a safeguard.
    for (int round = 0; round < 8 && resolve_one_conflict(context); ++round) grow(context);
    for (std::size_t g = 0; g < layout_.size() && !context.cancelled(); ++g)
      spread(layout_, g, tolerance_, 4);
    return layout_;
  }

 private:
  /// Joins groups, the most telling bundle first, until no bundle is left that holds.
  void grow(const Context& context) {
    refused_.clear();
    bundles_.clear();
    const std::size_t most = layout_.size();
    for (std::size_t done = 0;;) {
      const std::vector<Bundle> bundles = sorted_bundles();
      const auto good = std::find_if(bundles.begin(), bundles.end(), [&](const Bundle& bundle) {
        if (context.cancelled() || refused_.count(key(bundle)) > 0) return false;
        if (try_merge(bundle)) return true;
        refused_.insert(key(bundle));
        return false;
      });
      if (good == bundles.end()) return;
      forget_bundles_of(good->first, good->second);
      context.report("assembling", static_cast<double>(++done) / static_cast<double>(most));
    }
  }

  /// Before groups changed that are one now.
  void forget_bundles_of(std::size_t first, std::size_t second) {
    std::erase_if(bundles_, [&](const auto& known) {
      const auto& [groups, bundles] = known;
      return groups.first == first || groups.first == second || groups.second == first ||
             groups.second == second;
    });
  }

  std::vector<Bundle> sorted_bundles() {
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> between;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const std::size_t a = layout_.group(links_[i].a);
      const std::size_t b = layout_.group(links_[i].b);
      if (a != b) between[std::minmax(a, b)].push_back(i);
    }
    std::vector<Bundle> bundles;
    for (const auto& [groups, indices] : between) {
      const auto [known, fresh] = bundles_.try_emplace(groups);
      if (fresh) known->second = bundles_between(groups.first, groups.second, indices);
      bundles.insert(bundles.end(), known->second.begin(), known->second.end());
    }
    std::stable_sort(bundles.begin(), bundles.end(),
                     [](const Bundle& p, const Bundle& q) { return p.strength() > q.strength(); });
    return bundles;
  }

  Planar motion(const Link& link, std::size_t first) const {
    const Planar moved = layout_.pose(link.a) * link.pose * inverse(layout_.pose(link.b));
    return layout_.group(link.a) == first ? moved : inverse(moved);
  }

  std::vector<Bundle> bundles_between(std::size_t first, std::size_t second,
                                      const std::vector<std::size_t>& indices) const {
    std::vector<Bundle> bundles;
    std::vector<Planar> moves;
    std::vector<Motion> motions;
    for (const std::size_t index : indices) {
      moves.push_back(motion(links_[index], first));
      motions.emplace_back(moves.back());
    }
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const Link& seed = links_[indices[k]];
      Bundle bundle{first, second, moves[k], 0.0, 0.0, indices[k]};
      const std::size_t piece = layout_.group(seed.a) == second ? seed.a : seed.b;
      const Silhouette& shape = shapes_[piece];
      const glm::dvec2 centre = layout_.pose(piece)(0.5 * (shape.low + shape.high));
      const double reach = kSameShift * glm::distance(shape.low, shape.high);
      const glm::dvec2 there = motions[k](centre);
      std::map<std::pair<std::size_t, std::size_t>, Told> told;
      for (std::size_t other = 0; other < indices.size(); ++other) {
        if (glm::distance(there, motions[other](centre)) >= reach) continue;
        if (angle_between(moves[k], moves[other]) >= kSameTurn) continue;
        const Link& link = links_[indices[other]];
        Told& most = told[{link.a, link.b}];
        most.evidence = std::max(most.evidence, link.evidence);
        most.information = std::max(most.information, link.information);
      }
      for (const auto& [pair, most] : told) {
        bundle.evidence += most.evidence;
        bundle.sure += most.evidence >= detail::evidence_of(kSureScore) ? 1 : 0;
        bundle.information += most.information;
      }
      bundles.push_back(bundle);
    }
    return bundles;
  }

  /// A bundle by its seed and the sizes of its groups: as groups grow, what was refused may hold.
  std::array<std::size_t, 3> key(const Bundle& bundle) const {
    return {bundle.seed, layout_.members(bundle.first).size(), layout_.members(bundle.second).size()};
  }

  bool try_merge(const Bundle& bundle) {
    // A group that is far off shows before anything is moved.
    const auto fits = [&](const PlacedContact& c) { return !intrudes(c.contact, 3.0); };
    const bool near = layout_.visit_contacts(bundle.first, bundle.second, bundle.moved, fits);
    if (!near && bundle.sure < 2) return false;
    Layout trial = layout_;
    trial.merge(bundle.first, bundle.second, bundle.moved);
    // A ring of small pieces that closes: its error has added up, and each of two sure joins says that it is one.
    if (!near)
      for (const double reach : {8.0, 4.0}) trial.spread_error(bundle.first, reach * tolerance_, 2);
    spread(trial, bundle.first, 2.0 * tolerance_, 2);
    spread(trial, bundle.first, tolerance_, 2);
    std::vector<PlacedContact> across;
    for (const PlacedContact& c : trial.contacts_within(bundle.first))
      if (layout_.group(c.a) != layout_.group(c.b)) across.push_back(c);
    Bundle settled = bundle;
    settled.information = 0.0;
    for (const PlacedContact& c : across) settled.information += c.contact.information;
    if (settled.strength() < options_.least_strength || across.empty() || !hold(across)) return false;
    layout_ = std::move(trial);
    return true;
  }

  /// Spreads a group's error, over shorter reaches where that would carry likely joins away, and not at all if it still does, or of two pieces: borders
  /// that part at the ends of a short contact draw at each other, too.
  void spread(Layout& layout, std::size_t group, double tolerance, int iterations) const {
    const bool has_loops = layout.members(group).size() > 2;
    for (double reach = tolerance; reach > kLeastReach * tolerance; reach *= 0.5)
      if (try_spread(layout, group, reach, iterations) || !has_loops) return;
  }

  /// \return false, and nothing has moved: it would carry a likely join away
  bool try_spread(Layout& layout, std::size_t group, double tolerance, int iterations) const {
    Layout moved = layout;
    moved.spread_error(group, tolerance, iterations);
    const bool carries_away = std::ranges::any_of(links_, [&](const Link& link) {
      return link.score >= kLikelyJoin && layout.group(link.a) == group &&
             detail::lies_so(link, pieces_, layout) && !detail::lies_so(link, pieces_, moved);
    });
    if (!carries_away) layout = std::move(moved);
    return !carries_away;
  }

  bool intrudes(const Contact& contact, double leniency) const {
    const double allowed = options_.most_intrusion * contact.length + 3.0 * tolerance_;
    return contact.intrusion > leniency * allowed;
  }

  bool hold(const std::vector<PlacedContact>& contacts) const {
    return std::none_of(contacts.begin(), contacts.end(),
                        [&](const PlacedContact& c) { return intrudes(c.contact, 1.0); });
  }

  /// The pieces that are in a bundle's way, if less than what it says holds them; else none.
  std::set<std::size_t> cheaper_obstacles(const Bundle& bundle) const {
    std::set<std::size_t> obstacles;
    double lost = 0.0;
    const auto note = [&](const PlacedContact& c) {
      if (!intrudes(c.contact, 1.0)) return true;
      const double support_a = layout_.support(c.a);
      const double support_b = layout_.support(c.b);
      if (obstacles.insert(support_a < support_b ? c.a : c.b).second) lost += std::min(support_a, support_b);
      return lost < bundle.information;
    };
    return layout_.visit_contacts(bundle.first, bundle.second, bundle.moved, note) ? obstacles
                                                                                   : std::set<std::size_t>{};
  }

  /// Looks for a refused bundle that says more than what holds the pieces in its way, takes these off and joins it.
  bool resolve_one_conflict(const Context& context) {
    for (const Bundle& bundle : sorted_bundles()) {
      if (context.cancelled() || bundle.strength() < options_.least_strength) return false;
      const std::set<std::size_t> in_the_way = cheaper_obstacles(bundle);
      if (in_the_way.empty()) continue;
      Layout before = layout_;
      for (const std::size_t piece : in_the_way) layout_.take_off(piece);
      const Link& seed = links_[bundle.seed];
      const std::size_t first = layout_.group(seed.a);
      Bundle again{first,           layout_.group(seed.b), motion(seed, first),
                   bundle.evidence, bundle.information,    bundle.seed,
                   bundle.sure};
      if (again.first != again.second && try_merge(again)) {
        for (const std::size_t piece : in_the_way) layout_.take_off(piece);
        for (std::size_t g = 0; g < layout_.size(); ++g)
          if (!layout_.members(g).empty()) layout_.split_loose(g, kLeastJoin);
        return true;
      }
      layout_ = std::move(before);
    }
    return false;
  }

  const LinkedPieces& pieces_;
  const std::vector<Silhouette>& shapes_;
  const std::vector<Link>& links_;
  double tolerance_;
  const AssemblyOptions& options_;
  Layout layout_;
  std::set<std::array<std::size_t, 3>> refused_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Bundle>> bundles_;  // between groups as they are
};

/// The best link of a pair at about the pose in which the pieces lie now; null if the search for pairs proposed no such join.
const Link* proposed_link(const LinkedPieces& pieces, const SharedBorder& border, const Layout& layout) {
  const Link* best = nullptr;
  for (const Link& link : pieces.links) {
    if (link.a != border.a || link.b != border.b || !detail::lies_so(link, pieces, layout)) continue;
    if (best == nullptr || link.score > best->score) best = &link;
  }
  return best;
}

/// Reads the result off the layout.
class Description {
 public:
  Description(const std::vector<Piece>& pieces, const LinkedPieces& linked, const Layout& layout)
      : pieces_(pieces), linked_(linked), layout_(layout) {}

  Assembly assembly() {
    result_.placements.resize(layout_.size());
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t g = 0; g < layout_.size(); ++g) {
      const std::vector<std::size_t>& members = layout_.members(g);
      if (members.size() > 1 && add_joins(g)) {
        groups.push_back(members);
        continue;
      }
      for (const std::size_t piece : members) groups.push_back({piece});
    }
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& p, const auto& q) { return p.size() > q.size(); });
    for (std::size_t number = 0; number < groups.size(); ++number) place(groups[number], number);
    std::sort(result_.unplaced.begin(), result_.unplaced.end());
    std::stable_sort(result_.joins.begin(), result_.joins.end(),
                     [](const AssemblyJoin& p, const AssemblyJoin& q) {
                       return std::tie(p.score, p.contact) > std::tie(q.score, q.contact);
                     });
    result_.rms = length_ > 0.0 ? std::sqrt(squares_ / length_) : 0.0;
    return std::move(result_);
  }

 private:
  void place(const std::vector<std::size_t>& members, std::size_t number) {
    const bool alone = members.size() == 1;
    for (const std::size_t piece : members) {
      result_.placements[piece].pose = alone ? Planar{} : layout_.pose(piece);
      result_.placements[piece].group = number;
      if (alone) result_.unplaced.push_back(piece);
    }
  }

  AssemblyJoin described(const SharedBorder& border) const {
    AssemblyJoin join{border.a, border.b, 0.0, border.length, false, {}};
    if (const Link* link = proposed_link(linked_, border, layout_)) {
      join.proposed = true;
      join.rivals = detail::rivals_of(*link, linked_, layout_);
      join.score = detail::contested_score(link->score, join.rivals);
    }
    return join;
  }

  /// \return false, and nothing is added: the group's pieces share no more than corners
  bool add_joins(std::size_t group) {
    std::map<std::pair<std::size_t, std::size_t>, double> contacts;
    for (const PlacedContact& c : layout_.contacts_within(group)) contacts[{c.a, c.b}] = c.contact.length;
    std::vector<Planar> poses;
    poses.reserve(layout_.size());
    for (std::size_t i = 0; i < layout_.size(); ++i) poses.push_back(layout_.pose(i));
    const std::vector<SharedBorder> borders =
        shared_borders(pieces_, layout_.members(group), poses, linked_.tolerance);
    const auto is_touch = [&](const SharedBorder& border) {
      return std::min(contacts[{border.a, border.b}], border.length) < kShortestJoin * linked_.step;
    };
    if (std::ranges::all_of(borders, is_touch)) return false;
    for (const SharedBorder& border : borders) {
      const AssemblyJoin join = described(border);
      for (const std::size_t piece : {border.a, border.b}) {
        double& confidence = result_.placements[piece].confidence;
        confidence = 1.0 - (1.0 - confidence) * (1.0 - join.score);
      }
      if (is_touch(border)) {
        result_.touches.push_back(join);
        continue;
      }
      result_.joins.push_back(join);
      squares_ += border.length * border.rms * border.rms;
      length_ += border.length;
    }
    return true;
  }

  const std::vector<Piece>& pieces_;
  const LinkedPieces& linked_;
  const Layout& layout_;
  Assembly result_;
  double squares_ = 0.0;
  double length_ = 0.0;
};

Assembly assemble_linked(const std::vector<Piece>& pieces, const LinkedPieces& linked,
                         const AssemblyOptions& options, const Context& context) {
  const Layout layout = Assembler(linked, options).run(context);
  Assembly assembly = Description(pieces, linked, layout).assembly();
  if (!context.cancelled()) assembly.refused = detail::refused_of(linked, assembly.unplaced);
  assembly.similarity = detail::similarity(linked);
  assembly.cancelled = context.cancelled();
  return assembly;
}

}  // namespace

Assembly assemble(const std::vector<Piece>& pieces, const std::vector<PairResult>& pairs,
                  const AssemblyOptions& options, const Context& context) {
  if (pieces.empty()) return {};
  detail::NamesOfPairs alike;
  for (std::size_t a = 0; a < pieces.size(); ++a)
    for (std::size_t b = a + 1; b < pieces.size(); ++b)
      if (congruent(pieces[a].outline, pieces[b].outline)) alike.insert({a, b});
  const LinkedPieces linked = detail::link_pieces(pieces, pairs, options, alike);
  Assembly assembly = assemble_linked(pieces, linked, options, context);
  assembly.repeats = detail::repeats_of(pieces, assembly, alike);
  return assembly;
}

namespace {

/// Length of all joins.
double joined_length(const Assembly& assembly) {
  double length = 0.0;
  for (const AssemblyJoin& join : assembly.joins) length += join.contact;
  return length;
}

/// Two pieces, and what is known of them.
struct PairOfPieces {
  std::size_t a = 0;
  std::size_t b = 0;
  std::size_t place = 0;   // among the results
  bool matched = false;    // to the end
  bool congruent = false;  // never matched
};

/// \param stage  what progress is told of
/// \param results  for (0, 1), (0, 2) .. (0, n - 1), (1, 2) ..; those of the pairs are set
void match_all(const std::vector<Piece>& pieces, const Matcher& matcher, std::string_view stage,
               std::vector<PairOfPieces>& names, std::vector<PairResult>& results, const Context& context) {
  // In portions, so that progress is told from one thread and a wish to stop is heard.
  constexpr std::size_t kPortion = 64;
  for (std::size_t begin = 0; begin < names.size() && !context.cancelled(); begin += kPortion) {
    const std::size_t count = std::min(kPortion, names.size() - begin);
    parallel_for(count, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = begin + first; i < begin + last; ++i) {
        PairOfPieces& pair = names[i];
        if (!pair.congruent) pair.congruent = congruent(pieces[pair.a].outline, pieces[pair.b].outline);
        if (!pair.congruent) results[pair.place] = matcher.match(pair.a, pair.b, context);
        pair.matched = !context.cancelled();
      }
    });
    context.report(stage, static_cast<double>(begin + count) / static_cast<double>(names.size()));
  }
}

}  // namespace

Assembly assemble(const std::vector<Piece>& pieces, const Matcher& matcher, const AssemblyOptions& options,
                  const Context& context) {
  if (pieces.empty()) return {};
  std::vector<PairOfPieces> names;
  for (std::size_t a = 0; a < pieces.size(); ++a)
    for (std::size_t b = a + 1; b < pieces.size(); ++b) names.push_back({a, b, names.size()});
  std::vector<PairResult> pairs(names.size());
  match_all(pieces, matcher, "matching pairs", names, pairs, context);
  // A wish to stop that ended the search must not throw away what it found; to join that takes moments.
  const Context joining([&](std::string_view stage, double fraction) { context.report(stage, fraction); });
  const bool search_ended = context.cancelled();
  detail::NamesOfPairs alike;
  for (const PairOfPieces& pair : names)
    if (pair.congruent) alike.insert({pair.a, pair.b});
  LinkedPieces linked = detail::link_pieces(pieces, pairs, options, alike);
  Assembly assembly = assemble_linked(pieces, linked, options, search_ended ? joining : context);
  if (options.second != nullptr && !assembly.unplaced.empty() && !context.cancelled()) {
    std::vector<PairOfPieces> left;
    const auto alone = [&](std::size_t p) { return std::ranges::binary_search(assembly.unplaced, p); };
    std::ranges::copy_if(names, std::back_inserter(left),
                         [&](const PairOfPieces& pair) { return alone(pair.a) || alone(pair.b); });
    options.second->prepare(pieces);
    std::vector<PairResult> more(names.size());
    match_all(pieces, *options.second, "matching what is left", left, more, context);
    for (const PairOfPieces& pair : left) names[pair.place].matched = pair.matched;
    if (detail::add_links(linked, more, options)) {
      Assembly other = assemble_linked(pieces, linked, options, context.cancelled() ? joining : context);
      const double gain = joined_length(other) - joined_length(assembly);
      if (gain > kShortestJoin * linked.step) assembly = std::move(other);
    }
  }
  assembly.cancelled = context.cancelled();
  assembly.repeats = detail::repeats_of(pieces, assembly, alike);
  std::set<std::size_t> open;
  for (const PairOfPieces& pair : names)
    if (!pair.matched) open.insert({pair.a, pair.b});
  const auto tried = std::stable_partition(assembly.unplaced.begin(), assembly.unplaced.end(),
                                           [&](std::size_t piece) { return open.count(piece) == 0; });
  std::erase_if(assembly.refused, [&](const AssemblyRival& one) { return open.count(one.piece) > 0; });
  assembly.untried.assign(tried, assembly.unplaced.end());
  assembly.unplaced.erase(tried, assembly.unplaced.end());
  return assembly;
}

}  // namespace rejoin::outline
