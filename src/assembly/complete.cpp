#include "assembly/complete.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include "core/parallel.hpp"
#include "match/align.hpp"
#include "match/judge.hpp"
#include "match/verify.hpp"

namespace rejoin::assembly {
namespace {

constexpr double kLeastScore = 0.3;  // of the links that are combined
constexpr std::size_t kPerPair = 2;
constexpr std::size_t kMostAround = 50;  // links of a piece, the best: of many copies all fit all
constexpr std::size_t kMost = 1000;      // combinations that are aligned, or so many for each piece:
constexpr std::size_t kMostOfPiece = 8;
constexpr double kLikely = 0.5;  // of what comes out

using Key = std::pair<std::size_t, std::size_t>;

/// The same join seen from the other side.
Link turned(const Link& link) {
  return {link.b, link.a, inverse(link.pose), link.score, link.holds, link.slides};
}

/// Best first.
void sort_by_score(std::vector<Link>& links) {
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& x, const Link& y) { return x.score > y.score; });
}

/// The best links of each pair, a < b.
std::map<Key, std::vector<Link>> best_links(const std::vector<Link>& links) {
  std::map<Key, std::vector<Link>> result;
  for (const Link& link : links) {
    if (link.score < kLeastScore || link.slides) continue;  // what slides leads to no definite place
    result[{std::min(link.a, link.b), std::max(link.a, link.b)}].push_back(link.a < link.b ? link
                                                                                           : turned(link));
  }
  for (auto& [key, list] : result) {
    sort_by_score(list);
    if (list.size() > kPerPair) list.resize(kPerPair);
  }
  return result;
}

/// A combination a-k, k-b of two links.
struct Guess {
  Link link;     ///< a-b, a < b; `score` is the product of both
  bool decides;  ///< false if both are sure: they put all three together anyhow
};

std::vector<Guess> combinations(const std::vector<Link>& links, std::size_t pieces, double sure) {
  std::vector<std::vector<Link>> from(pieces);  // by its a
  for (const auto& [key, list] : best_links(links)) {
    for (const Link& link : list) {
      from[link.a].push_back(link);
      from[link.b].push_back(turned(link));
    }
  }
  std::vector<Guess> result;
  for (auto& around : from) {
    if (around.size() > kMostAround) {
      sort_by_score(around);
      around.resize(kMostAround);
    }
    for (const Link& x : around) {
      for (const Link& y : around) {
        if (x.b >= y.b) continue;
        const bool both_sure = x.holds && y.holds && std::min(x.score, y.score) >= sure;
        result.push_back({{x.b, y.b, inverse(x.pose) * y.pose, x.score * y.score}, !both_sure});
      }
    }
  }
  return result;
}

/// Those that decide something first, the likeliest of them.
void sort_by_worth(std::vector<Guess>& guesses) {
  std::stable_sort(guesses.begin(), guesses.end(), [](const Guess& x, const Guess& y) {
    return std::tie(y.decides, y.link.score) < std::tie(x.decides, x.link.score);
  });
}

class Completer {
 public:
  Completer(const std::vector<Piece>& pieces, const std::vector<Link>& links, const Options& options)
      : pieces_(pieces), options_(options) {
    for (const Link& link : links) known_[{link.a, link.b}].push_back(link.pose);
  }

  /// Whether two pieces touch so, and no link says it.
  bool is_open(const Link& guess) const {
    const Piece& a = pieces_[guess.a];
    const Piece& b = pieces_[guess.b];
    return !is_known(guess) && are_near(a, b, guess.pose, 0.0) &&
           touch(a, b, guess.pose).area >= kContact * std::min(a.area(), b.area());
  }

  std::optional<Link> judged(const Link& guess) const {
    const match::Fragment& a = pieces_[guess.a].fragment();
    const match::Fragment& b = pieces_[guess.b].fragment();
    const match::Joint fresh(a, b);
    std::optional<Link> link = judged(guess, fresh);
    if (!link && match::tell_wear(a, b)) link = judged(guess, fresh.worn());
    return link;
  }

 private:
  std::optional<Link> judged(const Link& guess, const match::Joint& joint) const {
    const Piece& a = pieces_[guess.a];
    const Piece& b = pieces_[guess.b];
    const double tolerance = joint.tolerance();
    const Rigid rough = joint.align(match::to_origins(a.fragment(), b.fragment(), guess.pose),
                                    {24.0 * tolerance, 4.0 * tolerance, 16, 300});
    const Rigid fine = joint.align(rough, {12.0 * tolerance, 3.0 * tolerance, 20, 0});
    const match::Judged found = match::judge(joint, fine);
    const double score = match::score_of(match::strength(found.evidence));
    if (score < kLikely) return std::nullopt;
    // No search told what else these two would do: the pairs it follows from bear witness.
    const Rigid pose = match::to_files(a.fragment(), b.fragment(), fine);
    const Link link{guess.a, guess.b, pose, score, false, found.evidence.doubt == match::Doubt::Slide};
    const bool stayed = same_pose(a, b, guess.pose, link.pose, options_);
    if (!stayed || is_known(link) || interpenetrate(a, b, link.pose)) return std::nullopt;
    return link;
  }

  bool is_known(const Link& link) const {
    const auto same = [&](const Key& key, const Rigid& pose) {
      const auto found = known_.find(key);
      return found != known_.end() &&
             std::any_of(found->second.begin(), found->second.end(), [&](const Rigid& other) {
               return same_pose(pieces_[key.first], pieces_[key.second], pose, other, options_);
             });
    };
    return same({link.a, link.b}, link.pose) || same({link.b, link.a}, inverse(link.pose));
  }

  const std::vector<Piece>& pieces_;
  const Options& options_;
  std::map<Key, std::vector<Rigid>> known_;
};

}  // namespace

std::vector<Link> completed_triangles(const std::vector<Piece>& pieces, const std::vector<Link>& links,
                                      const Options& options, const Context& context) {
  std::vector<Guess> all = combinations(links, pieces.size(), options.sure);
  sort_by_worth(all);
  const Completer completer(pieces, links, options);
  const std::size_t most = std::max(kMost, kMostOfPiece * pieces.size());
  std::vector<Link> guesses;
  for (std::size_t next = 0; next < all.size() && guesses.size() < most; next += kMost) {
    std::vector<std::uint8_t> open(std::min(kMost, all.size() - next));
    parallel_for(open.size(), 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last && !context.cancelled(); ++k)
        open[k] = completer.is_open(all[next + k].link) ? 1 : 0;
    });
    for (std::size_t k = 0; k < open.size() && guesses.size() < most; ++k)
      if (open[k] != 0) guesses.push_back(all[next + k].link);
  }
  std::vector<std::optional<Link>> found(guesses.size());
  parallel_for(guesses.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last && !context.cancelled(); ++k)
      found[k] = completer.judged(guesses[k]);
  });
  std::vector<Link> result;
  for (const auto& link : found) {
    if (!link) continue;
    const bool repeated = std::any_of(result.begin(), result.end(), [&](const Link& other) {
      return other.a == link->a && other.b == link->b &&
             same_pose(pieces[link->a], pieces[link->b], other.pose, link->pose, options);
    });
    if (!repeated) result.push_back(*link);
  }
  return result;
}

}  // namespace rejoin::assembly
