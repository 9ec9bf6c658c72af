#include "outline/calibrate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "core/random.hpp"
#include "outline/detail/coding.hpp"
#include "outline/detail/pairing.hpp"
#include "outline/join_fit.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

/// Lengths of the known candidates, samples.
constexpr std::array<std::int32_t, 5> kLengths{6, 10, 16, 26, 42};
/// Values of zeta that are tried.
constexpr std::array<double, 5> kZetas{1.0, 1.5, 2.0, 2.5, 3.5};
/// Borders that lie this near to each other at the true pose are one, steps.
constexpr double kNear = 2.0;
constexpr int kBand = 4;
constexpr std::size_t kLeastCandidates = 10;
/// The ends of known candidates are refined with this threshold, as the search would.
constexpr double kLenient = 1.5;
/// Chance resemblances are looked for with this threshold.
constexpr double kChance = 1.2;

/// A known candidate: its length, weighted by relief as in the discriminant, and its mismatch for each of kZetas.
struct Known {
  double length = 0.0;
  std::array<double, kZetas.size()> mismatch{};
  bool is_true = false;
};

/// The pieces at one scale.
struct Level {
  std::vector<const ScaleSignal*> signals;
  std::vector<detail::Coded> coded;

  detail::Sequences sequences(std::size_t a, std::size_t b) const {
    return {&coded[a].forward, &coded[b].backward};
  }
};

/// S^2 and length of the best pairing near a stretch.  zeta is a multiple of 1, the scale's usual turning.
Known measure(const detail::Sequences& sequences, const std::vector<detail::PairedSamples>& stretch,
              bool is_true) {
  Known known;
  known.is_true = is_true;
  for (std::size_t z = 0; z < kZetas.size(); ++z) {
    const detail::ScaleParameters lenient{kLenient, kZetas[z], 0.0};
    const detail::Candidate best = detail::refine(sequences, lenient, stretch, kBand);
    // Delta is linear in xi^2: two values give the length that it multiplies and the mismatch.
    const double without = detail::discriminant(sequences, best.path, {0.0, kZetas[z], 0.0});
    const double with = detail::discriminant(sequences, best.path, {1.0, kZetas[z], 0.0});
    known.mismatch[z] = without;
    if (z == 0) known.length = without - with;
  }
  return known;
}

/// Where sample i of A lies on B at the true pose: positions in B's backward sequence, a run of neighbours.
std::vector<detail::PairedSamples> true_pairing(const ScaleSignal& a, const ScaleSignal& b,
                                                const Planar& pose) {
  std::vector<glm::dvec2> moved;
  moved.reserve(b.points.size());
  for (const glm::dvec2& p : b.points) moved.push_back(pose(p));
  std::vector<detail::PairedSamples> pairing;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const auto nearest =
        std::min_element(moved.begin(), moved.end(), [&](const glm::dvec2& x, const glm::dvec2& y) {
          return glm::distance(x, a.points[i]) < glm::distance(y, a.points[i]);
        });
    if (glm::distance(*nearest, a.points[i]) > kNear * a.step) continue;
    const auto j = static_cast<std::int32_t>(moved.end() - nearest) - 1;
    pairing.push_back({static_cast<std::int32_t>(i), j});
  }
  return pairing;
}

/// Stretches of a pairing that run on without jumps.
std::vector<std::vector<detail::PairedSamples>> stretches(const std::vector<detail::PairedSamples>& pairing,
                                                          std::int32_t length) {
  std::vector<std::vector<detail::PairedSamples>> result;
  std::vector<detail::PairedSamples> run;
  for (const detail::PairedSamples& p : pairing) {
    const bool runs_on =
        run.empty() || (p.i == run.back().i + 1 && p.j >= run.back().j && p.j <= run.back().j + 3);
    if (!runs_on) run.clear();
    run.push_back(p);
    if (static_cast<std::int32_t>(run.size()) < length) continue;
    result.push_back(std::move(run));
    run.clear();
  }
  return result;
}

void add_true(const Level& level, const std::vector<KnownJoin>& joins, std::size_t most,
              std::vector<Known>& known) {
  const std::size_t share =
      std::max<std::size_t>(1, most / std::max<std::size_t>(1, joins.size() * kLengths.size()));
  for (const KnownJoin& join : joins) {
    const auto pairing = true_pairing(*level.signals[join.a], *level.signals[join.b], join.pose);
    for (const std::int32_t length : kLengths) {
      const auto found = stretches(pairing, length);
      for (std::size_t k = 0; k < std::min(share, found.size()); ++k)
        known.push_back(measure(level.sequences(join.a, join.b), found[k], true));
    }
  }
}

void add_false(const Level& level, const std::set<std::pair<std::size_t, std::size_t>>& joined,
               std::size_t most, Random& random, std::vector<Known>& known) {
  const auto count = static_cast<std::uint32_t>(level.signals.size());
  std::size_t added = 0;
  for (std::size_t trial = 0; trial < most && added < most; ++trial) {
    const std::size_t a = random.below(count);
    const std::size_t b = random.below(count);
    if (a == b || joined.count({std::min(a, b), std::max(a, b)}) > 0) continue;
    const std::int32_t length = kLengths[trial % kLengths.size()];
    const auto found = detail::initial_candidates(level.sequences(a, b), {kChance, kChance, 0.0}, length, 1);
    // Once round a border that has fewer samples at this scale it is shorter.
    if (found.empty() || found[0].path.size() < static_cast<std::size_t>(length)) continue;
    std::vector<detail::PairedSamples> stretch = found[0].path;
    stretch.resize(static_cast<std::size_t>(length));
    known.push_back(measure(level.sequences(a, b), stretch, false));
    ++added;
  }
}

/// The line that leaves the fewest candidates on its wrong side, over a grid of its parameters.
void separate(const std::vector<Known>& known, CalibratedLevel& result) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t z = 0; z < kZetas.size(); ++z) {
    for (int x = 2; x <= 40; ++x) {
      const double xi2 = std::pow(0.05 * x, 2.0);
      for (int n = 0; n <= 48; ++n) {
        const double n_min = 0.5 * n;
        double wrong_true = 0.0;
        double wrong_false = 0.0;
        for (const Known& k : known) {
          const bool said = k.mismatch[z] < xi2 * (k.length - n_min);
          if (said != k.is_true) (k.is_true ? wrong_true : wrong_false) += 1.0;
        }
        const double mistaken = 0.5 * (wrong_true / static_cast<double>(result.true_candidates) +
                                       wrong_false / static_cast<double>(result.false_candidates));
        if (mistaken >= best) continue;
        best = mistaken;
        result.level = {0.05 * x, kZetas[z], n_min};
        result.mistaken = mistaken;
      }
    }
  }
}

}  // namespace

std::vector<CalibratedLevel> calibrate(const std::vector<Piece>& pieces, const std::vector<KnownJoin>& joins,
                                       const CalibrateOptions& options, const Context& context) {
  const double step = JoinFitter(pieces, FitOptions{options.step}).step();
  std::vector<std::vector<ScaleSignal>> scales;
  scales.reserve(pieces.size());
  for (const Piece& piece : pieces)
    scales.push_back(scale_space(piece.outline.points, {step, options.scales}));
  std::set<std::pair<std::size_t, std::size_t>> joined;
  for (const KnownJoin& join : joins) joined.emplace(std::min(join.a, join.b), std::max(join.a, join.b));
  Random random(options.seed);
  std::vector<CalibratedLevel> results;
  for (std::size_t k = 0; k < static_cast<std::size_t>(options.scales) && !context.cancelled(); ++k) {
    context.report("calibrating", static_cast<double>(k) / options.scales);
    Level level;
    const double usual = detail::usual_turning(scales, k, any_of_pixels(pieces));
    for (const auto& piece : scales) {
      level.signals.push_back(&piece[k]);
      level.coded.push_back(detail::encode(piece[k], usual));
    }
    std::vector<Known> known;
    add_true(level, joins, static_cast<std::size_t>(options.samples), known);
    CalibratedLevel result;
    result.step = step * std::pow(2.0, static_cast<double>(k));
    result.level = default_level();
    result.mistaken = 0.5;
    result.true_candidates = known.size();
    add_false(level, joined, static_cast<std::size_t>(options.samples), random, known);
    result.false_candidates = known.size() - result.true_candidates;
    result.calibrated =
        result.true_candidates >= kLeastCandidates && result.false_candidates >= kLeastCandidates;
    if (result.calibrated) separate(known, result);
    results.push_back(result);
  }
  return results;
}

}  // namespace rejoin::outline
