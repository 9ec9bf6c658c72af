#include "assembly/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <string_view>
#include <tuple>

#include "assembly/complete.hpp"
#include "assembly/grow.hpp"
#include "assembly/pairs.hpp"
#include "assembly/spread.hpp"
#include "core/parallel.hpp"
#include "match/judge.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kFound = 0.006;   // contact without a candidate: least share of the smaller piece's surface
constexpr double kMet = 0.0005;    // of a pair that must join, the same
constexpr double kSpacing = 0.15;  // between groups, share of the larger one's size

std::vector<Piece> make_pieces(const std::vector<match::Fragment>& fragments, const Context& context) {
  std::vector<std::optional<Piece>> slots(fragments.size());
  std::mutex reporting;
  std::size_t done = 0;
  parallel_for(fragments.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      slots[k].emplace(fragments[k]);
      const std::lock_guard lock(reporting);
      context.report("prepare", static_cast<double>(++done) / static_cast<double>(slots.size()));
    }
  });
  std::vector<Piece> pieces;
  pieces.reserve(slots.size());
  for (auto& slot : slots) pieces.push_back(std::move(*slot));
  return pieces;
}

/// The given links in an order that does not depend on theirs, and those that follow from them.
std::vector<Link> all_links(const std::vector<Piece>& pieces, std::vector<Link> links, const Options& options,
                            const Context& context) {
  std::stable_sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
    return std::tie(y.score, x.a, x.b) < std::tie(x.score, y.a, y.b);
  });
  const std::vector<Link> more = completed_triangles(pieces, links, options, context);
  links.insert(links.end(), more.begin(), more.end());
  return links;
}

/// Grows, and again with each strong join first that was left out, as long as that gives more evidence.
Growth best_growth(Grower& grower, const Options& options, const Context& context) {
  std::set<std::size_t> first;
  const Context half([&](std::string_view stage, double part) { context.report(stage, 0.5 * part); },
                     context);
  const Context silent({}, context);
  Growth best = grower.grow(first, half);
  std::set<std::size_t> tried;
  for (int k = 0; k < options.retries && !context.cancelled(); ++k) {
    context.report("grow", 0.5 + 0.5 * static_cast<double>(k) / options.retries);
    const std::vector<std::size_t> left_out = grower.unsatisfied(best);
    const auto next =
        std::find_if(left_out.begin(), left_out.end(), [&](std::size_t l) { return tried.count(l) == 0; });
    if (next == left_out.end()) break;
    tried.insert(*next);
    std::set<std::size_t> with = first;
    with.insert(*next);
    Growth other = grower.grow(with, silent);
    if (context.cancelled() || other.evidence <= best.evidence + 1e-9) continue;
    best = std::move(other);
    first = std::move(with);
  }
  return best;
}

class Assembler {
 public:
  Assembler(const std::vector<match::Fragment>& fragments, const std::vector<Link>& links,
            const Options& options, const Context& context)
      : options_(options),
        pieces_(make_pieces(fragments, context)),
        given_(links.size()),
        links_(all_links(pieces_, links, options, context)),
        grower_(pieces_, links_, options_) {}

  Result run(const Context& context) {
    Result result;
    grow(result, context);
    const bool grown = !context.cancelled();
    result.placements.resize(pieces_.size());
    number_groups(result);
    context.report("align", 0.5);
    for (std::size_t g = 0; g < members_.size(); ++g) {
      if (!context.cancelled()) grower_.settle(growth_, members_[g]);
      context.report("align", 0.5 + 0.5 * static_cast<double>(g + 1) / static_cast<double>(members_.size()));
    }
    for (const auto& members : members_) find_joins(members, result);
    std::stable_sort(result.joins.begin(), result.joins.end(),
                     [](const Join& x, const Join& y) { return x.score > y.score; });
    lay_out();
    for (std::size_t k = 0; k < pieces_.size(); ++k) result.placements[k].pose = growth_.poses[k];
    tell_confidence(result);
    tell_reasons(result, grown);
    tell_parted_objects(result);
    tell_broken_wishes(result);
    result.cancelled = context.cancelled();
    return result;
  }

 private:
  bool is_pinned(std::size_t piece) const {
    const auto& pinned = options_.constraints.pinned;
    return std::any_of(pinned.begin(), pinned.end(), [&](const auto& p) { return p.first == piece; });
  }

  /// Grows without the pairs that must join, as most of them join anyhow, and once more with those that do not.  A pair's best
  /// candidate may be false: put first, it would take true joins with it.
  void grow(Result& result, const Context& context) {
    growth_ = best_growth(grower_, options_, context);
    const Growth unasked = growth_;
    std::vector<std::pair<std::size_t, std::size_t>> unmet;
    while (!context.cancelled() && add_unmet(unmet, context)) {
      grower_.want(unmet);
      Growth other = best_growth(grower_, options_, context);
      if (context.cancelled()) return;  // with what was put together before
      growth_ = std::move(other);
    }
    if (!unmet.empty() && !context.cancelled()) tell_given_up(unasked, result);
  }

  /// Adds the pairs that must join and do not; false if there are no more.
  bool add_unmet(std::vector<std::pair<std::size_t, std::size_t>>& unmet, const Context& context) const {
    const std::size_t before = unmet.size();
    Growth settled = growth_;
    std::set<std::size_t> done;  // groups
    for (const auto& pair : options_.constraints.must_join) {
      if (context.cancelled()) return false;
      if (std::find(unmet.begin(), unmet.end(), pair) != unmet.end()) continue;
      const std::size_t group = growth_.group[pair.first];
      if (group == growth_.group[pair.second] && done.insert(group).second)
        grower_.settle(settled, members_of(group));
      if (!touch_in(settled, pair.first, pair.second)) unmet.push_back(pair);
    }
    return unmet.size() > before;
  }

  std::vector<std::size_t> members_of(std::size_t group) const {
    std::vector<std::size_t> members;
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (growth_.group[k] == group) members.push_back(k);
    return members;
  }

  bool touch_in(const Growth& growth, std::size_t a, std::size_t b) const {
    const Rigid b_to_a = inverse(growth.poses[a]) * growth.poses[b];
    return growth.group[a] == growth.group[b] &&
           touch(pieces_[a], pieces_[b], b_to_a).area > kMet * smaller_area(a, b);
  }

  /// Sure joins that had to go for pairs that must join.
  /// \param unasked  grown without them
  void tell_given_up(const Growth& unasked, Result& result) const {
    const std::vector<std::size_t> lost_before = grower_.unsatisfied(unasked);
    for (const std::size_t link : grower_.unsatisfied(growth_)) {
      if (std::find(lost_before.begin(), lost_before.end(), link) != lost_before.end()) continue;
      result.warnings.push_back(
          fmt::format("{{{}}} and {{{}}} (score {:.3f}) join no more, for the sake of pairs that must",
                      links_[link].a, links_[link].b, links_[link].score));
    }
  }

  void number_groups(Result& result) {
    std::map<std::size_t, std::vector<std::size_t>> by_group;
    for (std::size_t k = 0; k < pieces_.size(); ++k) by_group[growth_.group[k]].push_back(k);
    for (auto& [group, members] : by_group) {
      if (members.size() > 1 || is_pinned(members.front())) members_.push_back(std::move(members));
    }
    std::stable_sort(members_.begin(), members_.end(),
                     [](const auto& x, const auto& y) { return x.size() > y.size(); });
    result.groups = static_cast<int>(members_.size());
    for (std::size_t g = 0; g < members_.size(); ++g) {
      for (const std::size_t piece : members_[g]) result.placements[piece].group = static_cast<int>(g);
    }
  }

  Rigid relative(std::size_t a, std::size_t b) const { return inverse(growth_.poses[a]) * growth_.poses[b]; }

  double smaller_area(std::size_t a, std::size_t b) const {
    return std::min(pieces_[a].area(), pieces_[b].area());
  }

  void find_joins(const std::vector<std::size_t>& members, Result& result) const {
    const std::set<std::size_t> used(growth_.used.begin(), growth_.used.end());
    for (std::size_t x = 0; x < members.size(); ++x) {
      for (std::size_t y = x + 1; y < members.size(); ++y) {
        const std::size_t a = members[x];
        const std::size_t b = members[y];
        const std::size_t link = grower_.agreeing(growth_, a, b);
        const bool matched = link < links_.size();
        if (among(options_.constraints.must_not_join, a, b)) continue;
        const Touch contact = touch(pieces_[a], pieces_[b], relative(a, b));
        const double share = contact.area / smaller_area(a, b);
        const double least = among(options_.constraints.must_join, a, b) ? kMet : matched ? kContact : kFound;
        if (share < least && !(matched && used.count(link) != 0)) continue;
        const double score =
            matched
                ? links_[link].score
                : match::score_of(match::strength(
                      match::judge(pieces_[a].fragment(), pieces_[b].fragment(), relative(a, b)).evidence));
        result.joins.push_back({a, b, score, contact.area, contact.gap_median, link >= given_});
      }
    }
  }

  /// Groups side by side along x, so that a viewer shows them apart; a group with pinned members stays.
  void lay_out() {
    std::vector<std::size_t> pinned;
    for (const auto& members : members_)
      if (has_pinned(members)) pinned.insert(pinned.end(), members.begin(), members.end());
    glm::dvec3 next(0.0);  // where the following group begins in x, and its middle in y and z
    if (!pinned.empty()) {
      const auto [low, high] = extent(pinned);
      next = {high.x + kSpacing * (high.x - low.x), 0.5 * (low.y + high.y), 0.5 * (low.z + high.z)};
    }
    bool first = pinned.empty();
    for (const auto& members : members_) {
      if (has_pinned(members)) continue;
      const auto [low, high] = extent(members);
      const double width = high.x - low.x;
      if (!first) next.x += kSpacing * width;
      const glm::dvec3 shift = next - glm::dvec3(low.x, 0.5 * (low.y + high.y), 0.5 * (low.z + high.z));
      for (const std::size_t k : members) growth_.poses[k] = Rigid{glm::dmat3(1.0), shift} * growth_.poses[k];
      next.x += (1.0 + kSpacing) * width;
      first = false;
    }
  }

  bool has_pinned(const std::vector<std::size_t>& members) const {
    return std::any_of(members.begin(), members.end(), [&](std::size_t k) { return is_pinned(k); });
  }

  /// Corners of a box around pieces where they lie.
  std::pair<glm::dvec3, glm::dvec3> extent(const std::vector<std::size_t>& members) const {
    glm::dvec3 low(1e300);
    glm::dvec3 high(-1e300);
    for (const std::size_t k : members) {
      const glm::dvec3 centre = growth_.poses[k](pieces_[k].centre());
      low = glm::min(low, centre - pieces_[k].radius());
      high = glm::max(high, centre + pieces_[k].radius());
    }
    return {low, high};
  }

  void tell_confidence(Result& result) const {
    std::vector<double> odds(pieces_.size(), 0.0);
    std::vector<int> count(pieces_.size(), 0);
    for (const Join& join : result.joins) {
      for (const std::size_t piece : {join.a, join.b}) {
        const double more = count[piece]++ > 0 ? options_.loop_weight : 0.0;  // joins come strongest first
        odds[piece] += more > 0.0 ? std::max(0.0, log_odds(join.score) + more) : log_odds(join.score);
      }
    }
    for (std::size_t k = 0; k < growth_.used.size(); ++k) {
      const Link& link = links_[growth_.used[k]];
      for (const std::size_t piece : {link.a, link.b}) odds[piece] = std::max(odds[piece], growth_.odds[k]);
    }
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      Placement& placement = result.placements[k];
      if (placement.group < 0) continue;
      placement.confidence = is_pinned(k) ? 1.0 : 1.0 / (1.0 + std::exp(-odds[k]));
    }
  }

  static std::string why(const Rejection& rejection, const Link& link) {
    const std::string join = fmt::format("its join with {{{}}} (score {:.3f})", link.b, link.score);
    switch (rejection.why) {
      case Rejection::Why::Overlap:
        return join + fmt::format(" would put {{{}}} and {{{}}} into each other", rejection.a, rejection.b);
      case Rejection::Why::Forbidden:
        return join + fmt::format(" would make {{{}}} and {{{}}} touch, which must not join", rejection.a,
                                  rejection.b);
      case Rejection::Why::Contradiction:
        break;
    }
    return join + fmt::format(" contradicts that of {{{}}} and {{{}}}", rejection.a, rejection.b);
  }

  void tell_reasons(Result& result, bool grown) const {
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      Placement& placement = result.placements[k];
      if (placement.group >= 0) continue;
      for (const Rejection& rejection : growth_.rejected) {
        Link link = links_[rejection.link];
        if (link.b == k) std::swap(link.a, link.b);
        if (link.a != k || !placement.reason.empty()) continue;
        placement.reason = why(rejection, link);
      }
      if (placement.reason.empty())
        placement.reason = grown ? best_of(k) : "interrupted before it was put together";
    }
  }

  /// What the best candidate of a piece without strong ones was.
  std::string best_of(std::size_t piece) const {
    const Link* best = nullptr;
    for (const Link& link : links_) {
      if ((link.a == piece || link.b == piece) && (best == nullptr || link.score > best->score)) best = &link;
    }
    if (best == nullptr) return "no pose was found for it with any other fragment";
    const auto named = [&](const char* said) {
      return fmt::format("{} {{{}}}, score {:.3f}", said, best->a == piece ? best->b : best->a, best->score);
    };
    if (among(options_.constraints.must_not_join, best->a, best->b))
      return named("its best join is one that must not be: with");
    if (best->score < match::kPossible)
      return fmt::format("nothing fits it: its best score with another fragment is {:.3f}", best->score);
    if (best->slides)
      return named("no join is sure: the best is with") + ", and one slides along the other there";
    if (best->holds || best->score < options_.sure) return named("no join is sure: the best is with");
    if (static_cast<std::size_t>(best - links_.data()) >= given_)
      return named("no join is sure: the best follows from two other pairs alone, with");
    return named("no join is sure: the best is with") +
           ", but another pose of the two comes near, or parts of their surfaces disagree on the pose";
  }

  /// Sure joins between two objects that cannot lie as they say, the strongest of each two: often a second scan of pieces makes an
  /// object of its own.
  void tell_parted_objects(Result& result) const {
    std::set<std::pair<int, int>> told;
    for (const Rejection& rejection : growth_.rejected) {
      const Link& link = links_[rejection.link];
      const auto groups = std::minmax(result.placements[link.a].group, result.placements[link.b].group);
      if (rejection.why != Rejection::Why::Overlap || link.score < options_.sure || !link.holds) continue;
      if (groups.first < 0 || groups.first == groups.second || !told.insert(groups).second) continue;
      result.doubts.push_back(
          fmt::format("{{{}}} and {{{}}} join (score {:.3f}) but are put into two objects, as that would put "
                      "{{{}}} and {{{}}} into each other: {}",
                      link.a, link.b, link.score, rejection.a, rejection.b,
                      question(result, groups, {rejection.a, rejection.b})));
    }
  }

  /// What to ask the user where two objects part though two pieces of theirs join.
  /// \param overlap  the two that would be in each other
  std::string question(const Result& result, const std::pair<int, int>& groups,
                       const std::set<std::size_t>& overlap) const {
    const auto group = [&](std::size_t piece) { return result.placements[piece].group; };
    for (const auto& [a, b] : options_.constraints.must_not_join) {
      if (std::minmax({group(a), group(b)}) == groups)
        return fmt::format("do {{{}}} and {{{}}} not join, as you said?", a, b);
    }
    for (const auto& [a, b] : options_.constraints.must_join) {
      if (group(a) == group(b) && (overlap.count(a) != 0 || overlap.count(b) != 0))
        return fmt::format("do {{{}}} and {{{}}} join, as you said?", a, b);
    }
    return "are these two scans of one piece, or like pieces that broke alike?";
  }

  void tell_broken_wishes(Result& result) const {
    for (const auto& [a, b] : options_.constraints.must_join) {
      if (touch_in(growth_, a, b)) {
        tell_worse_pose(a, b, result);
      } else {
        result.warnings.push_back(fmt::format("{{{}}} and {{{}}} must join, but {}", a, b, why_apart(a, b)));
      }
    }
    for (const auto& [a, b] : options_.constraints.must_not_join) {
      if (growth_.group[a] != growth_.group[b] || !touch_forbidden(pieces_[a], pieces_[b], relative(a, b)))
        continue;
      result.warnings.push_back(fmt::format("{{{}}} and {{{}}} must not join, but touch{}", a, b,
                                            is_pinned(a) && is_pinned(b) ? " at the poses given" : ""));
    }
    for (const std::size_t link : grower_.parted_by_pins(growth_)) {
      const Link& l = links_[link];
      result.warnings.push_back(
          fmt::format("the poses given part {{{}}} and {{{}}} (score {:.3f})", l.a, l.b, l.score));
    }
    const auto& pinned = options_.constraints.pinned;
    for (std::size_t i = 0; i < pinned.size(); ++i)
      for (std::size_t j = i + 1; j < pinned.size(); ++j) tell_of_given_poses(pinned[i], pinned[j], result);
  }

  /// Why a pair that must join does not.
  std::string why_apart(std::size_t a, std::size_t b) const {
    if (is_pinned(a) && is_pinned(b)) return "do not touch at the poses given";
    if (std::ranges::any_of(links_, [&](const Link& l) { return key_of(l.a, l.b) == key_of(a, b); }))
      return "at none of their poses they fit";
    const auto why = options_.without_pose.find(key_of(a, b));
    const std::string none = "no pose of the two is known";
    return why == options_.without_pose.end() ? none : fmt::format("{}: {}", none, why->second);
  }

  /// Of a pair that must join, that its best pose does not fit.
  void tell_worse_pose(std::size_t a, std::size_t b, Result& result) const {
    const auto is_theirs = [&](std::size_t link) {
      return key_of(links_[link].a, links_[link].b) == key_of(a, b);
    };
    const auto used = std::ranges::find_if(growth_.used, is_theirs);
    if (used == growth_.used.end()) return;  // where other joins put them
    const Rejection* better = nullptr;
    double most = links_[*used].score;
    for (const Rejection& rejection : growth_.rejected) {
      if (!is_theirs(rejection.link) || rejection.why == Rejection::Why::Contradiction) continue;
      if (links_[rejection.link].score <= most) continue;
      most = links_[rejection.link].score;
      better = &rejection;
    }
    if (better == nullptr) return;
    result.warnings.push_back(fmt::format(
        "{{{}}} and {{{}}} join at a pose of score {:.3f}, as at their best ({:.3f}) {{{}}} and {{{}}} would "
        "{}",
        a, b, links_[*used].score, most, better->a, better->b,
        better->why == Rejection::Why::Overlap ? "lie in each other" : "touch, which must not join"));
  }

  /// Given poses are kept whatever they do.
  void tell_of_given_poses(const std::pair<std::size_t, Rigid>& first,
                           const std::pair<std::size_t, Rigid>& second, Result& result) const {
    const auto [a, b] = std::pair(first.first, second.first);
    if (cross(pieces_[a], pieces_[b], inverse(first.second) * second.second))
      result.warnings.push_back(fmt::format("the poses given put {{{}}} and {{{}}} into each other", a, b));
  }

  const Options& options_;
  std::vector<Piece> pieces_;
  std::size_t given_;  ///< of the links; the others follow from them
  std::vector<Link> links_;
  Grower grower_;
  Growth growth_;
  std::vector<std::vector<std::size_t>> members_;  ///< of every group
};

}  // namespace

Result assemble(const std::vector<match::Fragment>& fragments, const std::vector<Link>& links,
                const Options& options, const Context& context) {
  return Assembler(fragments, links, options, context).run(context);
}

}  // namespace rejoin::assembly
