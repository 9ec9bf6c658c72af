#include "outline/detail/lcs_scale.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "outline/common_subsequence.hpp"
#include "outline/detail/independence.hpp"
#include "outline/detail/local_alignment.hpp"
#include "outline/detail/odds.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kRounds = 4;                    // of seam and fit
constexpr double kReach = 8.0;                // samples: tolerance of the first seam
constexpr double kLeastSeam = 1.0;            // windows
constexpr double kIndependentInWindow = 3.0;  // samples that noise leaves independent in a window, at most
constexpr double kEvenEvidence = 12.0;        // a score of one half
constexpr double kEvidenceScale = 3.0;

/// The sample nearest to a place on a border.
std::uint32_t sample_at(const Turns& turns, double place) {
  const auto above = std::lower_bound(turns.places.begin(), turns.places.end(), place);
  return static_cast<std::uint32_t>((above - turns.places.begin()) %
                                    static_cast<std::ptrdiff_t>(turns.places.size()));
}

}  // namespace

LcsScale::LcsScale(const std::vector<Piece>& pieces, const LcsOptions& options, double step)
    : options_(options), step_(step), pieces_(pieces.size()) {
  parallel_for(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) pieces_[k] = prepared(pieces[k]);
  });
  std::vector<std::vector<float>> changes;
  changes.reserve(pieces.size());
  for (const Prepared& piece : pieces_) changes.push_back(piece.turns.change_deg);
  model_ = TurnModel(changes, options_.match_deg);
}

void LcsScale::search(std::size_t a, std::size_t b, const Context& context,
                      std::vector<LcsFit>& found) const {
  for (const bool flipped : {false, true}) {
    if (context.cancelled() || (flipped && !options_.flips)) return;
    for (const Guess& guess : guesses(pieces_[a], pieces_[b], flipped)) {
      if (context.cancelled()) return;
      const std::vector<PointPair> pairs = trusted(pieces_[a], pieces_[b], guess);
      const Planar pose = fit_pose(pairs, pose_of_three(pairs, flipped));
      if (auto fitted = fit(pieces_[a], pieces_[b], pose, guess.pairs[guess.centre], kReach))
        found.push_back(*fitted);
    }
  }
}

std::optional<LcsFit> LcsScale::refine(std::size_t a, std::size_t b, const LcsFit& coarse,
                                       double coarser) const {
  const SamplePair start{sample_at(pieces_[a].turns, coarse.middle_a),
                         sample_at(pieces_[b].turns, coarse.middle_b)};
  return fit(pieces_[a], pieces_[b], coarse.join.pose, start, std::max(kReach, 3.0 * coarser / step_));
}

/// Between the samples of a local alignment: neighbours in a window say nearly the same.
std::size_t LcsScale::stride() const {
  return std::max<std::size_t>(1, static_cast<std::size_t>(options_.window) / 9);
}

LcsScale::Prepared LcsScale::prepared(const Piece& piece) const {
  Prepared result;
  result.turns = turns_of(piece.outline.points, {step_, options_.window, options_.straight_deg});
  result.area = signed_area(piece.outline.points);
  result.perimeter = perimeter(piece.outline.points);
  const std::size_t n = result.turns.points.size();
  for (std::size_t i = 0; i < n; i += stride()) {
    const float change = result.turns.change_deg[i];
    result.levels.push_back(static_cast<std::uint8_t>(TurnModel::level(change)));
    result.partner[1].push_back(static_cast<std::uint8_t>(TurnModel::level(-change)));
  }
  result.partner[0].assign(result.partner[1].rbegin(), result.partner[1].rend());
  for (std::size_t i = 0; i < n; i += 4) result.coarse.points.push_back(result.turns.points[i]);
  return result;
}

std::vector<LcsScale::Guess> LcsScale::guesses(const Prepared& a, const Prepared& b, bool flipped) const {
  const Order order = flipped ? Order::Negated : Order::ReversedNegated;
  const auto tolerance = static_cast<float>(options_.match_deg);
  std::vector<Guess> result;
  const CyclicMatch whole = cyclic_lcs(a.turns.values, b.turns.values, tolerance, order);
  if (whole.pairs.size() >= 4) {
    Guess& guess = result.emplace_back(Guess{{}, whole.centre, flipped});
    for (const auto& [i, j] : whole.pairs) guess.pairs.emplace_back(a.turns.index[i], b.turns.index[j]);
  }
  if (!options_.local) return result;
  const std::vector<std::uint8_t>& partner = b.partner[flipped ? 1 : 0];
  for (const LocalMatch& local : local_alignments(a.levels, partner, model_, {})) {
    if (local.pairs.size() < 4) continue;
    Guess& guess = result.emplace_back(Guess{{}, local.pairs.size() / 2, flipped});
    for (const auto& [i, j] : local.pairs) {
      const std::size_t in_b = flipped ? j : partner.size() - 1 - j;
      guess.pairs.emplace_back(static_cast<std::uint32_t>(i * stride()),
                               static_cast<std::uint32_t>(in_b * stride()));
    }
  }
  return result;
}

/// The matches around the centre, as points.  \source naiman 2018, section 7.1
std::vector<PointPair> LcsScale::trusted(const Prepared& a, const Prepared& b, const Guess& guess) const {
  const std::size_t count = guess.pairs.size();
  const auto reach = std::max<std::size_t>(
      2, static_cast<std::size_t>(std::lround(options_.confidence * static_cast<double>(count))));
  const std::size_t first = guess.centre > reach ? guess.centre - reach : 0;
  const std::size_t last = std::min(count, guess.centre + reach + 1);
  std::vector<PointPair> pairs;
  pairs.reserve(last - first);
  for (std::size_t k = first; k < last; ++k)
    pairs.push_back(
        {a.turns.points[guess.pairs[k].first], b.turns.points[guess.pairs[k].second], glm::dvec2(0.0)});
  return pairs;
}

/// The pair of samples nearest to each other around the guess's centre.
LcsScale::SamplePair LcsScale::meeting(const Prepared& a, const Prepared& b, const Planar& pose,
                                       SamplePair from) const {
  const auto m = static_cast<std::uint32_t>(b.turns.points.size());
  const std::uint32_t reach = std::min<std::uint32_t>(m / 2, static_cast<std::uint32_t>(options_.window));
  double least = 1e300;
  std::uint32_t best = from.second;
  for (std::uint32_t k = 0; k <= 2 * reach; ++k) {
    const std::uint32_t j = (from.second + m - reach + k) % m;
    const double d = glm::distance(a.turns.points[from.first], pose(b.turns.points[j]));
    if (d >= least) continue;
    least = d;
    best = j;
  }
  return {from.first, best};
}

/// From a rough pose to a pose with its seam: the tolerance shrinks as the seam is fitted.
/// \param reach  first tolerance, samples
std::optional<LcsFit> LcsScale::fit(const Prepared& a, const Prepared& b, Planar pose, SamplePair start,
                                    double reach) const {
  Seam seam;
  for (int round = 0; round < kRounds; ++round) {
    const double tolerance = step_ * std::max(3.0, round == 0 ? reach : 0.625 * reach);
    start = meeting(a, b, pose, start);
    seam = find_seam(a.turns.points, b.turns.points, pose, start, {round < 2 ? tolerance : 3.0 * step_, 12});
    if (seam.length < kLeastSeam * options_.window * step_) return std::nullopt;
    if (round + 1 < kRounds) pose = fit_pose(along(a, b, seam), pose);
    start = seam.pairs[seam.pairs.size() / 2];
  }
  return judged(a, b, pose, seam);
}

/// A seam's pairs with A's normals.
std::vector<PointPair> LcsScale::along(const Prepared& a, const Prepared& b, const Seam& seam) const {
  const std::size_t n = a.turns.points.size();
  std::vector<PointPair> pairs;
  pairs.reserve(seam.pairs.size());
  for (const auto& [i, j] : seam.pairs) {
    const glm::dvec2 t = a.turns.points[(i + 2) % n] - a.turns.points[(i + n - 2) % n];
    const double length = std::max(glm::length(t), 1e-12);
    pairs.push_back({a.turns.points[i], b.turns.points[j], glm::dvec2(t.y, -t.x) / length});
  }
  return pairs;
}

std::optional<LcsFit> LcsScale::judged(const Prepared& a, const Prepared& b, const Planar& pose,
                                       const Seam& seam) const {
  LcsFit result;
  result.join.pose = pose;
  const auto& [first_a, first_b] = seam.pairs.front();
  const auto& [last_a, last_b] = seam.pairs.back();
  const auto along = [](const Prepared& piece, std::uint32_t from, std::uint32_t to) {
    const double length = piece.turns.places[to] - piece.turns.places[from];
    return length < 0.0 ? length + piece.perimeter : length;
  };
  const double length_a = along(a, first_a, last_a);
  const double length_b = pose.flipped ? along(b, first_b, last_b) : along(b, last_b, first_b);
  result.join.boundary = {a.turns.places[first_a], b.turns.places[first_b], 0.5 * (length_a + length_b), 0, 0,
                          length_b - length_a};
  const auto& [middle_a, middle_b] = seam.pairs[seam.pairs.size() / 2];
  result.middle_a = a.turns.places[middle_a];
  result.middle_b = b.turns.places[middle_b];
  const double overlap = overlap_area(a.coarse, b.coarse, pose);
  const double smaller = std::min(a.area, b.area);
  const double allowed = 3.0 * step_ * seam.length + 0.01 * smaller;
  if (overlap > 2.0 * allowed) return std::nullopt;
  result.evidence =
      agreement(a, b, seam, pose.flipped) * (1.0 - 0.5 * std::clamp(overlap / allowed - 0.5, 0.0, 1.0));
  result.join.score = score_of_odds((result.evidence - kEvenEvidence) / kEvidenceScale);
  return result;
}

/// How much likelier the two borders' turning along the seam is if they were one line, natural logarithm, for as many samples as
/// are independent: neighbours in a window tell the same, and so do those of a bend that is wider.
double LcsScale::agreement(const Prepared& a, const Prepared& b, const Seam& seam, bool flipped) const {
  double sum = 0.0;
  const std::size_t m = b.turns.points.size();
  std::vector<double> turns_a;
  std::vector<double> turns_b;
  for (const auto& [i, j] : seam.pairs) {
    // B runs the other way, so its change at j lies between j - 1 and j there; upside down it runs along, mirrored.
    const float turn_b = -b.turns.change_deg[flipped ? j : (j + m - 1) % m];
    turns_a.push_back(a.turns.change_deg[i]);
    turns_b.push_back(turn_b);
    sum += model_.score(TurnModel::level(a.turns.change_deg[i]), TurnModel::level(turn_b));
  }
  const double independent =
      std::min(kIndependentInWindow / options_.window * static_cast<double>(seam.pairs.size()),
               independent_samples(turns_a, turns_b));
  return independent / static_cast<double>(seam.pairs.size()) * sum / TurnModel::kUnit;
}

}  // namespace rejoin::outline::detail
