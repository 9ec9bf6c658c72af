#include "assembly/grow.hpp"

#include <algorithm>
#include <cmath>

#include "assembly/pairs.hpp"
#include "core/angle.hpp"
#include "core/parallel.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kLeastOdds = -6.0;  // links below are noise
constexpr double kDoubt = 1.0;      // log-odds by which a link that does not hold is less than sure, at least
constexpr double kWanted = 1000.0;  // certainty that goes before everything
constexpr double kFirst = 500.0;
constexpr double kWorthHearing = -6.0;   // certainty from which others are asked
constexpr double kTogether = 1.0;        // what two unsure joins need together above the limit for one
constexpr double kTogetherOdds = -5.0;   // of each, at least
constexpr double kTogetherWorth = -8.0;  // of both, for the third pair to be asked
constexpr std::size_t kMostTwos = 500;   // that say most without the third pair; others are not heard
constexpr double kNoLess = 500.0;        // more is as much
constexpr double kAlike =
    0.5;  // of what speaks for one place of two groups, for another, where patterns repeat
constexpr double kElsewhere = 3.0;      // of the distances within which poses are the same
constexpr std::size_t kProposals = 24;  // per two groups

}  // namespace

Grower::Grower(const std::vector<Piece>& pieces, const std::vector<Link>& links, const Options& options)
    : pieces_(pieces), links_(links), options_(options) {
  want(options.constraints.must_join);  // links that may be wanted are kept, however unlikely
  for (const auto& [a, b] : options.constraints.must_not_join) unwanted_.push_back(key_of(a, b));
  const double doubted = log_odds(options.sure) - kDoubt;  // too little for a link to be used alone
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double odds = log_odds(links[k].score);
    odds_.push_back(links[k].holds ? odds : std::min(odds, doubted));
    if (must(unwanted_, k)) continue;
    if (odds_[k] >= kLeastOdds || must(wanted_, k)) links_of_[key_of(links[k].a, links[k].b)].push_back(k);
  }
  for (auto& [pair, list] : links_of_) {
    std::stable_sort(list.begin(), list.end(),
                     [&](std::size_t x, std::size_t y) { return odds_[x] > odds_[y]; });
  }
  want({});
}

void Grower::want(const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  wanted_.clear();
  for (const auto& [a, b] : pairs) wanted_.push_back(key_of(a, b));
}

bool Grower::must(const std::vector<Key>& pairs, std::size_t link) const {
  return std::find(pairs.begin(), pairs.end(), key_of(links_[link].a, links_[link].b)) != pairs.end();
}

Growth Grower::grow(const std::set<std::size_t>& first, const Context& context) {
  State state = start(first);
  const auto groups = static_cast<double>(state.members.size());
  while (!context.cancelled() &&
         (try_best(state) || (hear(state, context) && try_best(state)) || try_two(state, context))) {
    context.report("grow", 1.0 - static_cast<double>(state.members.size()) / groups);
  }
  tell_contradictions(state);
  sum_up(state.growth);
  return state.growth;
}

Grower::State Grower::start(const std::set<std::size_t>& first) const {
  State state;
  state.first = &first;
  state.growth.poses.resize(pieces_.size());
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    state.growth.group.push_back(k);
    state.members[k] = {k};
  }
  state.between = links_of_;
  pin(state);
  for (const auto& [key, list] : state.between) propose(state, key);
  return state;
}

/// Pinned pieces are one group from the start.
void Grower::pin(State& state) const {
  const auto& pinned = options_.constraints.pinned;
  if (pinned.empty()) return;
  const std::size_t group = pinned.front().first;
  for (const auto& [piece, pose] : pinned) {
    state.growth.poses[piece] = pose;
    state.growth.group[piece] = group;
    if (piece == group) continue;
    state.members[group].push_back(piece);
    state.members.erase(piece);
  }
  state.between.clear();
  for (const auto& [pair, list] : links_of_) {
    const Key key = key_of(state.growth.group[pair.first], state.growth.group[pair.second]);
    if (key.first != key.second)
      state.between[key].insert(state.between[key].end(), list.begin(), list.end());
  }
}

Rigid Grower::transform(const State& state, std::size_t link, std::size_t into) const {
  const Link& l = links_[link];
  const Rigid b_to_a_group = state.growth.poses[l.a] * l.pose * inverse(state.growth.poses[l.b]);
  return state.growth.group[l.a] == into ? b_to_a_group : inverse(b_to_a_group);
}

Grower::Proposal Grower::weigh(const State& state, const Key& key, std::size_t link) const {
  Proposal proposal{link, odds_[link], 0.0, 0.0, 0.0, false, links_.size()};
  const Rigid second_to_first = transform(state, link, key.first);
  const double sure = log_odds(options_.sure);
  const Key own = key_of(links_[link].a, links_[link].b);
  std::map<Key, std::size_t> agreeing;
  std::map<Key, std::size_t> contrary;
  for (const std::size_t other : state.between.at(key)) {
    const Link& l = links_[other];
    const Key pair = key_of(l.a, l.b);
    if (pair == own) continue;
    const bool a_first = state.growth.group[l.a] == key.first;
    const Rigid b_group_to_a_group = a_first ? second_to_first : inverse(second_to_first);
    const Rigid predicted = inverse(state.growth.poses[l.a]) * b_group_to_a_group * state.growth.poses[l.b];
    auto& list = same_pose(pieces_[l.a], pieces_[l.b], l.pose, predicted, options_) ? agreeing : contrary;
    const auto [place, fresh] = list.try_emplace(pair, other);
    if (!fresh && odds_[other] > odds_[place->second]) place->second = other;
  }
  for (const auto& [pair, other] : agreeing) {
    const bool both_slide = links_[link].slides && links_[other].slides;
    proposal.agreeing += std::max(0.0, odds_[other] + (both_slide ? 0.0 : options_.loop_weight));
  }
  for (const auto& [pair, other] : contrary) {
    if (agreeing.count(pair) != 0 || odds_[other] < sure) continue;
    proposal.alone -= odds_[other];
    proposal.against = other;
  }
  if (state.first->count(link) != 0) proposal.wish += kFirst;
  if (must(wanted_, link)) proposal.wish += kWanted;
  return proposal;
}

void Grower::propose(State& state, const Key& key) const {
  std::vector<std::size_t> list = state.between.at(key);
  std::stable_sort(list.begin(), list.end(),
                   [&](std::size_t x, std::size_t y) { return odds_[x] > odds_[y]; });
  std::vector<Proposal> proposals;
  for (const std::size_t link : list) {
    if (proposals.size() >= kProposals && !must(wanted_, link) && state.first->count(link) == 0) continue;
    proposals.push_back(weigh(state, key, link));
  }
  rank(proposals);
  state.proposals[key] = std::move(proposals);
}

void Grower::rank(std::vector<Proposal>& proposals) {
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& x, const Proposal& y) { return x.certainty() > y.certainty(); });
}

/// Where a group's pieces lie off, no neighbour of theirs would fit.
void Grower::settle_all(State& state, const Context& context) const {
  for (const std::size_t group : state.unsettled) {
    if (context.cancelled()) return;
    settle(state.growth, state.members.at(group));
    for (const auto& [key, list] : state.between) {
      if (key.first == group || key.second == group) propose(state, key);
    }
  }
  state.unsettled.clear();
}

/// Asks the contacts of other pairs about every proposal that is not sure without.  True: one became so.
bool Grower::hear(State& state, const Context& context) {
  settle_all(state, context);
  const double sure = log_odds(options_.sure);
  std::vector<Proposal*> open;
  std::vector<Question> questions;
  for (auto& [key, list] : state.proposals) {
    if (state.members[key.first].size() + state.members[key.second].size() < 3) continue;
    for (Proposal& p : list) {
      if (p.heard || p.certainty() < kWorthHearing) continue;
      open.push_back(&p);
      questions.push_back(question(state, {p.link}));
    }
  }
  const Answers heard = answers(state, questions, context);
  bool any = false;
  for (std::size_t k = 0; k < open.size(); ++k) {
    Proposal& p = *open[k];
    p.heard = true;
    const Heard more = heard[k].value_or(Heard{});
    p.agreeing = p.agreeing > 0.0 ? std::max(p.agreeing, more.all) : more.all;
    p.vouched = more.unlinked;
    any = any || p.certainty() >= sure;
  }
  for (auto& [key, list] : state.proposals) rank(list);
  return any;
}

Grower::Question Grower::question(const State& state, std::vector<std::size_t> links) const {
  std::set<std::size_t> groups;
  for (const std::size_t link : links) {
    groups.insert(state.growth.group[links_[link].a]);
    groups.insert(state.growth.group[links_[link].b]);
  }
  Question result;
  for (const std::size_t group : groups) {
    result.groups.push_back(state.members.at(group));
    std::sort(result.groups.back().begin(), result.groups.back().end());
  }
  std::stable_sort(result.groups.begin(), result.groups.end(),
                   [](const auto& x, const auto& y) { return x.size() > y.size(); });
  for (const std::size_t link : state.growth.used)
    if (groups.count(state.growth.group[links_[link].a]) != 0) result.held_by.push_back(link);
  std::sort(result.held_by.begin(), result.held_by.end());
  std::sort(links.begin(), links.end());
  result.links = std::move(links);
  return result;
}

/// How the groups move that a question's links put together.
Grower::Moves Grower::moves(const State& state, const Question& question) const {
  Moves result{{state.growth.group[question.groups.front().front()], Rigid{}}};
  while (result.size() < question.groups.size()) {
    for (const std::size_t link : question.links) {
      const std::size_t of_a = state.growth.group[links_[link].a];
      const std::size_t of_b = state.growth.group[links_[link].b];
      if (result.count(of_a) == result.count(of_b)) continue;
      const auto [lies, comes] = result.count(of_a) != 0 ? Key{of_a, of_b} : Key{of_b, of_a};
      result.emplace(comes, result.at(lies) * transform(state, link, lies));
    }
  }
  return result;
}

/// What the contacts of other pairs add if links put groups together.
std::optional<Heard> Grower::answer(const State& state, const Question& question) const {
  std::vector<Rigid> poses = state.growth.poses;
  for (const auto& [group, move] : moves(state, question)) {
    for (const std::size_t piece : state.members.at(group)) poses[piece] = move * poses[piece];
  }
  std::vector<Link> links;
  for (const std::size_t link : question.links) links.push_back(links_[link]);
  const auto is_linked = [&](std::size_t a, std::size_t b, const Rigid& b_to_a) {
    return agreeing(a, b, b_to_a) != links_.size();
  };
  return hear_contacts(pieces_, links, question.groups, std::move(poses), options_, is_linked);
}

/// Answers of several questions, also of those that were asked before.
Grower::Answers Grower::answers(const State& state, const std::vector<Question>& questions,
                                const Context& context) {
  Answers result(questions.size());
  parallel_for(questions.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last && !context.cancelled(); ++k) {
      const auto known = answered_.find(questions[k]);
      result[k] = known != answered_.end() ? known->second : answer(state, questions[k]);
    }
  });
  for (std::size_t k = 0; k < questions.size(); ++k) answered_.emplace(questions[k], result[k]);
  return result;
}

/// Whether a piece that one of the links brings lies elsewhere by other moves of the same groups.
bool Grower::lies_elsewhere(const State& state, const std::vector<std::size_t>& links,
                            const Moves& moves) const {
  return std::ranges::any_of(links, [&](std::size_t link) {
    const Link& l = links_[link];
    const auto place = [&](std::size_t k) { return moves.at(state.growth.group[k]) * state.growth.poses[k]; };
    return !same_pose(pieces_[l.a], pieces_[l.b], l.pose, inverse(place(l.a)) * place(l.b), options_,
                      kElsewhere);
  });
}

/// What is left of log-odds, as groups lie in one way at most; nothing where much speaks for another as well: where a pattern repeats,
/// neighbours bear out each of several.
/// \param others  log-odds of the other ways
double Grower::among_places(double odds, const std::vector<double>& others) const {
  double sum = 0.0;
  double next = 0.0;
  for (const double other : others) {
    sum += std::exp(std::min(kNoLess, other));
    next = std::max(next, other);
  }
  const bool alike = next > log_odds(options_.sure) && next > kAlike * odds;
  return alike ? std::min(0.0, odds) : odds - std::log1p(sum);
}

/// among_places() of the first of the proposals of two groups, at least one.
double Grower::among_places(const State& state, const std::vector<Proposal>& list) const {
  std::vector<double> others;
  for (const Proposal& other : list) {
    if (lies_elsewhere(state, {list.front().link}, moves(state, question(state, {other.link}))))
      others.push_back(other.odds());
  }
  return among_places(list.front().odds(), others);
}

/// Uses the most certain proposal of all, or finds that it does not fit.  False: none is certain enough.
bool Grower::try_best(State& state) {
  std::vector<Proposal>* best = nullptr;
  double most = log_odds(options_.sure) - 1e-9;
  double odds = 0.0;
  for (auto& [key, list] : state.proposals) {
    if (list.empty() || list.front().certainty() <= most) continue;
    const double left = among_places(state, list);
    const bool wished = list.front().wish > 0.0;  // by the user, or where strong joins contradict each other
    if (!wished && left < log_odds(options_.sure) - 1e-9) continue;
    most = list.front().certainty();
    best = &list;
    odds = wished ? list.front().odds() : left;
  }
  if (best == nullptr) return false;
  const Proposal used = best->front();
  best->erase(best->begin());
  if (!fits(state, used.link)) return true;
  merge(state, used.link, odds);
  state.growth.vouched += used.vouched;
  return true;
}

/// Unsure links of two pairs of groups with one group in common, which are worth hearing together.
std::vector<Grower::Two> Grower::unsure_together(const State& state, const Context& context) {
  std::vector<const Proposal*> unsure;
  std::vector<Question> questions;
  for (const auto& [key, list] : state.proposals) {
    for (const Proposal& p : list) {
      if (p.certainty() < kTogetherOdds) continue;
      unsure.push_back(&p);
      questions.push_back(question(state, {p.link}));
    }
  }
  const Answers alone = answers(state, questions, context);
  struct End {
    const Proposal* proposal;
    std::size_t group;  // that it joins with the common one
    double heard;       // of it alone
  };
  std::map<std::size_t, std::vector<End>> ends;  // by the common group
  for (std::size_t k = 0; k < unsure.size(); ++k) {
    if (!alone[k]) continue;  // nor would it fit with another
    const Link& link = links_[unsure[k]->link];
    const auto [g, h] = key_of(state.growth.group[link.a], state.growth.group[link.b]);
    ends[g].push_back({unsure[k], h, alone[k]->all});
    ends[h].push_back({unsure[k], g, alone[k]->all});
  }
  std::vector<Two> result;
  for (const auto& [common, list] : ends) {
    for (std::size_t x = 0; x < list.size(); ++x) {
      for (std::size_t y = x + 1; y < list.size(); ++y) {
        const Proposal& p = *list[x].proposal;
        const Proposal& q = *list[y].proposal;
        if (list[x].group == list[y].group || p.certainty() + q.certainty() < kTogetherWorth) continue;
        const double one = p.alone + list[x].heard;
        const double other = q.alone + list[y].heard;
        const double worth = std::min({one, other, one + other});
        result.push_back({{p.link, q.link}, worth - list[x].heard - list[y].heard, worth});
      }
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Two& x, const Two& y) { return x.worth > y.worth; });
  if (result.size() > kMostTwos) result.resize(kMostTwos);
  return result;
}

/// The surest of some ways to put groups together, with what is left of its log-odds; nothing if that is no more than the least.
std::optional<Grower::Way> Grower::surest(const State& state, const std::vector<Way>& ways,
                                          double least) const {
  std::optional<Way> best;
  double most = least;
  for (const Way& way : ways) {
    if (way.odds <= most) continue;
    std::vector<double> others;
    for (const Way& other : ways) {
      if (other.question.groups == way.question.groups &&
          lies_elsewhere(state, way.question.links, moves(state, other.question)))
        others.push_back(other.odds);
    }
    const double left = among_places(way.odds, others);
    if (left <= least) continue;
    most = way.odds;
    best = {way.question, left, way.vouched};
  }
  return best;
}

/// Three groups that two unsure joins put together, so that contacts of other pairs speak for both at once.
bool Grower::try_two(State& state, const Context& context) {
  const std::vector<Two> unsure = unsure_together(state, context);
  std::vector<Question> questions;
  questions.reserve(unsure.size());
  for (const Two& two : unsure) questions.push_back(question(state, {two.links.begin(), two.links.end()}));
  std::vector<Way> ways;
  const Answers heard = answers(state, questions, context);
  for (std::size_t k = 0; k < unsure.size(); ++k) {
    if (heard[k]) ways.push_back({questions[k], unsure[k].alone + heard[k]->all, heard[k]->unlinked});
  }
  const std::optional<Way> best = surest(state, ways, log_odds(options_.sure) + kTogether);
  if (!best) return false;
  const std::vector<std::size_t>& links = best->question.links;
  for (const std::size_t link : links) {  // whatever happens, these two are not tried again
    auto& list =
        state.proposals[key_of(state.growth.group[links_[link].a], state.growth.group[links_[link].b])];
    const auto same = [&](const Proposal& p) { return p.link == link; };
    list.erase(std::remove_if(list.begin(), list.end(), same), list.end());
  }
  if (!fits(state, links[0])) return true;
  State both = state;  // neither is sure without the other
  merge(both, links[0], best->odds);
  if (!fits(both, links[1])) {
    state.growth.rejected = std::move(both.growth.rejected);
    return true;
  }
  merge(both, links[1], best->odds);
  both.growth.vouched += best->vouched;
  state = std::move(both);
  return true;
}

void Grower::merge(State& state, std::size_t link, double odds) const {
  std::size_t into = state.growth.group[links_[link].a];
  std::size_t from = state.growth.group[links_[link].b];
  const auto& pinned = options_.constraints.pinned;
  const bool fixed = !pinned.empty() && from == pinned.front().first;
  if (fixed || (state.members[from].size() > state.members[into].size() &&
                (pinned.empty() || into != pinned.front().first))) {
    std::swap(into, from);
  }
  const Rigid move = transform(state, link, into);
  for (const std::size_t piece : state.members[from]) {
    state.growth.poses[piece] = move * state.growth.poses[piece];
    state.growth.group[piece] = into;
    state.members[into].push_back(piece);
  }
  state.members.erase(from);
  state.unsettled.erase(from);
  state.unsettled.insert(into);
  state.growth.used.push_back(link);
  state.growth.odds.push_back(odds);

  std::map<Key, std::vector<std::size_t>> moved;
  for (auto entry = state.between.begin(); entry != state.between.end();) {
    const auto [g, h] = entry->first;
    if (g != from && h != from) {
      ++entry;
      continue;
    }
    const std::size_t other = g == from ? h : g;
    if (other != into) moved[key_of(into, other)] = std::move(entry->second);
    state.proposals.erase(entry->first);
    entry = state.between.erase(entry);
  }
  for (auto& [key, list] : moved) {
    auto& all = state.between[key];
    all.insert(all.end(), list.begin(), list.end());
    std::sort(all.begin(), all.end());
    propose(state, key);
  }
}

}  // namespace rejoin::assembly
