#include "outline/detail/links.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "core/parallel.hpp"
#include "outline/detail/odds.hpp"
#include "outline/detail/rivals.hpp"
#include "outline/join_fit.hpp"

namespace rejoin::outline::detail {
namespace {

// Borders touch within this many steps of the scale.
constexpr double kTolerance = 1.5;
// Candidates of a pair that are considered.
constexpr std::size_t kCandidates = 4;
// Odds of higher scores are no number.
constexpr double kCertain = 1.0 - 1e-12;
// Candidates of less than this score are noise.
constexpr double kLeastScore = 0.02;
// What the odds of a second search's candidates have less, nats: it is asked about what nothing else fits, where chance has more tries.
constexpr double kSecondSearch = 2.0;
// Nats that a coarser scale has to say more to be taken: where a short contact says nothing, borders near it do, wider apart.
constexpr double kCoarser = 4.0;
// A piece in a hole: whatever has about the hole's size follows its border round somehow, and mostly no other join tells more.
// So the search must find it likely, or this share of the piece's border must touch the hole's.
constexpr double kLeastInHole = 0.3;
constexpr double kLeastTouching = 0.9;

/// Whether a candidate that lays one piece into a hole of the other may be used; true for all others.
bool fills_hole(const JoinCandidate& candidate, const Silhouette& a, const Silhouette& b,
                const Contact& contact) {
  const Boundary& met = candidate.boundary;
  if ((met.hole_a == 0 && met.hole_b == 0) || candidate.score >= kLeastInHole) return true;
  const Ring& border = met.hole_a > 0 ? b.rings[0] : a.rings[0];
  return contact.length >= kLeastTouching * border.step * static_cast<double>(border.end);
}

/// Whether two motions of a piece, into the same frame, are about the same.
bool same_place(const Silhouette& piece, const Planar& p, const Planar& q) {
  if (angle_between(p, q) >= kSameTurn) return false;
  const glm::dvec2 centre = 0.5 * (piece.low + piece.high);
  return glm::distance(p(centre), q(centre)) < kSameShift * glm::distance(piece.low, piece.high);
}

/// The pose settled, or the pose itself where borders that part at the ends of a short contact would draw it elsewhere.
Planar settled(const Silhouette& a, const Silhouette& b, const Planar& pose, double tolerance) {
  const Planar moved = settle(a, b, pose, tolerance, 3);
  return same_place(b, pose, moved) ? moved : pose;
}

std::vector<Silhouette> silhouettes(const std::vector<Piece>& pieces, double step) {
  std::vector<std::unique_ptr<Silhouette>> made(pieces.size());
  parallel_for(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      made[i] = std::make_unique<Silhouette>(pieces[i].outline, step, 1.0);
  });
  std::vector<Silhouette> all;
  all.reserve(pieces.size());
  for (auto& one : made) all.push_back(std::move(*one));
  return all;
}

/// The candidates measured at one scale; those that overlap or say nothing are left out.
std::vector<Link> links_at(const std::vector<Silhouette>& shapes, const std::vector<PairResult>& pairs,
                           double tolerance, const AssemblyOptions& options) {
  std::vector<std::pair<std::size_t, std::size_t>> names;
  names.reserve(pairs.size());
  for (std::size_t a = 0; a < shapes.size(); ++a)
    for (std::size_t b = a + 1; b < shapes.size(); ++b) names.emplace_back(a, b);
  std::vector<std::vector<Link>> found(pairs.size());
  parallel_for(pairs.size(), 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto [a, b] = names[i];
      for (std::size_t k = 0; k < pairs[i].candidates.size() && k < kCandidates; ++k) {
        const Planar pose = settled(shapes[a], shapes[b], pairs[i].candidates[k].pose, tolerance);
        const Contact contact = measure_contact(shapes[a], shapes[b], pose, tolerance);
        const double score = pairs[i].candidates[k].score;
        if (score < kLeastScore) continue;
        if (contact.intrusion > options.most_intrusion * contact.length) continue;
        if (!fills_hole(pairs[i].candidates[k], shapes[a], shapes[b], contact)) continue;
        found[i].push_back(
            {a, b, pose, contact.information, contact.length, score, pairs[i].candidates[k].boundary, 0.0});
      }
    }
  });
  std::vector<Link> links;
  for (const std::vector<Link>& some : found) links.insert(links.end(), some.begin(), some.end());
  return links;
}

/// \pre shapes, perimeters and links are known
void weigh_rivals(LinkedPieces& linked) {
  linked.likely_of.assign(linked.shapes.size(), {});
  for (std::size_t k = 0; k < linked.links.size(); ++k) {
    if (linked.links[k].score < kLeastRival) continue;
    linked.likely_of[linked.links[k].a].push_back(k);
    linked.likely_of[linked.links[k].b].push_back(k);
  }
  parallel_for(linked.links.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      Link& link = linked.links[i];
      link.evidence = std::max(0.0, evidence_of(link.score) - odds_taken(link, linked));
    }
  });
}

/// What the best links of each piece say together.
double total_information(const std::vector<Link>& links, std::size_t pieces) {
  std::vector<double> best(pieces, 0.0);
  for (const Link& link : links) {
    best[link.a] = std::max(best[link.a], link.information);
    best[link.b] = std::max(best[link.b], link.information);
  }
  double sum = 0.0;
  for (const double value : best) sum += value;
  return sum;
}

/// The best candidates of all pairs only, to choose a scale by.
std::vector<PairResult> best_of(const std::vector<PairResult>& pairs, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!pairs[i].candidates.empty()) order.emplace_back(-pairs[i].candidates[0].score, i);
  std::sort(order.begin(), order.end());
  std::vector<PairResult> best(pairs.size());
  for (std::size_t k = 0; k < order.size() && k < most; ++k)
    best[order[k].second].candidates = {pairs[order[k].second].candidates[0]};
  return best;
}

/// The step, file units, at which the best candidates say most.
double fitting_step(const std::vector<Piece>& pieces, const std::vector<PairResult>& pairs,
                    const AssemblyOptions& options) {
  const double length = median_perimeter(pieces);
  const std::vector<PairResult> best = best_of(pairs, 2 * pieces.size());
  double most = -1.0 - kCoarser;
  double step = length;
  for (const double samples : options.samples) {
    const double trial = length / samples;
    const std::vector<Link> links = links_at(silhouettes(pieces, trial), best, kTolerance * trial, options);
    const double information = total_information(links, pieces.size());
    if (information <= most + kCoarser) continue;
    most = information;
    step = trial;
  }
  return step;
}

}  // namespace

double evidence_of(double score) {
  const double idle = score_of(0.0);  // of a candidate that says nothing
  return odds_of_score(std::clamp(score, idle, kCertain)) - odds_of_score(idle);
}

LinkedPieces link_pieces(const std::vector<Piece>& pieces, const std::vector<PairResult>& pairs,
                         const AssemblyOptions& options, NamesOfPairs alike) {
  LinkedPieces result;
  result.alike = std::move(alike);
  result.step = fitting_step(pieces, pairs, options);
  result.tolerance = kTolerance * result.step;
  result.shapes = silhouettes(pieces, result.step);
  result.links = links_at(result.shapes, pairs, result.tolerance, options);
  result.perimeters.reserve(pieces.size());
  for (const Piece& piece : pieces) result.perimeters.push_back(perimeter(piece.outline.points));
  weigh_rivals(result);
  return result;
}

bool add_links(LinkedPieces& linked, const std::vector<PairResult>& pairs, const AssemblyOptions& options) {
  std::vector<PairResult> doubted = pairs;
  for (PairResult& pair : doubted)
    for (JoinCandidate& candidate : pair.candidates)
      candidate.score = score_of_odds(odds_of_score(std::min(candidate.score, kCertain)) - kSecondSearch);
  const std::vector<Link> more = links_at(linked.shapes, doubted, linked.tolerance, options);
  linked.links.insert(linked.links.end(), more.begin(), more.end());
  std::ranges::stable_sort(linked.links, {}, [](const Link& link) { return std::pair(link.a, link.b); });
  weigh_rivals(linked);
  return !more.empty();
}

bool agree(const Link& p, const Link& q, const LinkedPieces& pieces) {
  return p.a == q.a && p.b == q.b && same_place(pieces.shapes[p.b], p.pose, q.pose);
}

bool lies_so(const Link& link, const LinkedPieces& pieces, const Layout& placed) {
  if (placed.group(link.a) != placed.group(link.b)) return false;
  return same_place(pieces.shapes[link.b], link.pose, inverse(placed.pose(link.a)) * placed.pose(link.b));
}

std::vector<std::vector<double>> similarity(const LinkedPieces& pieces) {
  const std::size_t count = pieces.shapes.size();
  std::vector<std::vector<double>> matrix(count, std::vector<double>(count, 0.0));
  std::map<std::pair<std::size_t, std::size_t>, double> best;
  for (const Link& link : pieces.links) {
    double& information = best[{link.a, link.b}];
    if (link.information <= information) continue;
    information = link.information;
    matrix[link.a][link.b] = matrix[link.b][link.a] = link.length;
  }
  return matrix;
}

}  // namespace rejoin::outline::detail
