#include "outline/detail/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "outline/detail/odds.hpp"

namespace rejoin::outline::detail {
namespace {

// Of the longer of two stretches: that much in common makes them one border.
constexpr double kSameBorder = 0.5;
constexpr double kTempered = 1.0 / 3.0;

/// A part of a piece's outer border, shares of it.
struct Stretch {
  double begin = 0.0;   // 0 <= begin < 1
  double length = 0.0;  // 0: along a hole
};

/// Length that two stretches of one closed border share, shares of it.
double in_common(const Stretch& p, const Stretch& q) {
  double sum = 0.0;
  for (const double round : {-1.0, 0.0, 1.0}) {
    const double begin = std::max(p.begin, q.begin + round);
    const double end = std::min(p.begin + p.length, q.begin + round + q.length);
    sum += std::max(0.0, end - begin);
  }
  return sum;
}

bool same_border(const Stretch& p, const Stretch& q) {
  return in_common(p, q) > kSameBorder * std::max(p.length, q.length);
}

/// Where on one of its pieces a link's pieces meet.
Stretch stretch_on(const Link& link, std::size_t piece, const LinkedPieces& pieces) {
  const Boundary& boundary = link.boundary;
  if (boundary.hole_a > 0 || boundary.hole_b > 0) return {};
  const bool backward = link.b == piece && !link.pose.flipped;
  const double length = link.a == piece ? boundary.length_a() : boundary.length_b();
  const double first = link.a == piece ? boundary.begin_a : boundary.begin_b - (backward ? length : 0.0);
  const double begin = first / pieces.perimeters[piece];
  return {begin - std::floor(begin), length / pieces.perimeters[piece]};
}

using IsNone = std::function<bool(const Link& other)>;

/// Links that ask for a link's border: the best score of each piece on either of the link's, but of other scans of the link's pieces.
std::map<std::pair<std::size_t, std::size_t>, double> best_rivals(const Link& link,
                                                                  const LinkedPieces& pieces,
                                                                  const IsNone& is_none) {
  std::map<std::pair<std::size_t, std::size_t>, double> best;
  const auto same_at = [&](const Link& other, std::size_t at) {
    return same_border(stretch_on(link, at, pieces), stretch_on(other, at, pieces));
  };
  const bool one_shape = pieces.are_alike(link.a, link.b);  // as cards are cut
  for (const std::size_t at : {link.a, link.b}) {
    const std::size_t beside = at == link.a ? link.b : link.a;
    for (const std::size_t k : pieces.likely_of[at]) {
      const Link& other = pieces.links[k];
      if (is_none(other) || !same_at(other, at)) continue;
      // Another scan of a piece asks for its place, not for another one's.
      if (!one_shape && pieces.are_alike(beside, other.a == at ? other.b : other.a)) continue;
      const bool is_told = at == link.b && other.a == link.a && other.b == link.b && same_at(other, link.a);
      if (is_told) continue;
      double& score = best[{other.a == at ? other.b : other.a, at}];
      score = std::max(score, other.score);
    }
  }
  return best;
}

/// Of what has this score.
double odds_of(double score) {
  constexpr double kLeast = 1e-12;
  return std::exp(odds_of_score(std::clamp(score, kLeast, 1.0 - kLeast)));
}

}  // namespace

std::vector<AssemblyRival> rivals_of(const Link& link, const LinkedPieces& pieces, const Layout& placed) {
  const auto best =
      best_rivals(link, pieces, [&](const Link& other) { return lies_so(other, pieces, placed); });
  std::vector<AssemblyRival> rivals;
  rivals.reserve(best.size());
  for (const auto& [names, score] : best) rivals.push_back({names.first, names.second, score});
  std::ranges::stable_sort(rivals, std::ranges::greater(), &AssemblyRival::score);
  return rivals;
}

double odds_taken(const Link& link, const LinkedPieces& pieces) {
  const auto best = best_rivals(link, pieces, [&](const Link& other) { return agree(link, other, pieces); });
  double odds = 0.0;  // that one of them is true
  for (const auto& [names, score] : best) odds += odds_of(score);
  return std::log1p(odds);
}

double contested_score(double score, const std::vector<AssemblyRival>& rivals) {
  double odds = 0.0;  // that one of them is true
  for (const AssemblyRival& rival : rivals) odds += odds_of(rival.score);
  if (odds <= 0.0) return score;
  return std::min(score, score_of_odds(kTempered * std::log(odds_of(score) / odds)));
}

std::vector<AssemblyRival> refused_of(const LinkedPieces& linked, const std::vector<std::size_t>& unplaced) {
  std::vector<AssemblyRival> refused;
  for (const std::size_t piece : unplaced) {
    AssemblyRival best;
    for (const Link& link : linked.links)
      if ((link.a == piece || link.b == piece) && link.score > best.score)
        best = {piece, link.a == piece ? link.b : link.a, link.score};
    if (best.score >= kSureScore) refused.push_back(best);
  }
  return refused;
}

}  // namespace rejoin::outline::detail
