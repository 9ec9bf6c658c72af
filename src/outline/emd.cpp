#include "outline/emd.hpp"

#include <algorithm>
#include <cmath>

#include "core/cyclic.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "outline/contact.hpp"
#include "outline/detail/odds.hpp"
#include "outline/frechet.hpp"

namespace rejoin::outline {
namespace {

// The Gaussian on the border, in samples.
constexpr double kSmoothing = 2.0;
// Borders touch within this many steps of the scale.
constexpr double kTolerance = 1.5;
// Stretches per scale that are laid on each other.
constexpr std::size_t kTried = 10;
// Of these, how many are grown with the transport problem solved, and how often each.
constexpr std::size_t kSolved = 3;
constexpr int kMostSolved = 4;
// Samples that a stretch has at least.
constexpr std::size_t kShortest = 6;
// A join in which more of a border than this share of the contact lies deep in the other piece is none.
constexpr double kMostIntrusion = 0.25;
// Information, in nats, at which the score is a half, and what makes the odds e times as good.
constexpr double kEvenInformation = 12.0;
constexpr double kInformationScale = 1.5;
// Candidates turned and shifted by less than this are one: radians, steps of the coarser scale.
constexpr double kEqualTurn = 0.05;
constexpr double kEqualShift = 6.0;

/// A piece at one scale.
struct ScaledPiece {
  PropertyPlot forward;
  PropertyPlot backward;
  Silhouette silhouette;
};

/// What a stretch must keep within the tolerance.
enum class Measure { EarthMover, Frechet };

class EmdMatcher final : public Matcher {
 public:
  EmdMatcher(const EmdOptions& options, Measure measure) : options_(options), measure_(measure) {}

  void prepare(const std::vector<Piece>& pieces) override {
    scales_.clear();
    if (pieces.empty()) return;
    perimeters_.clear();
    for (const Piece& piece : pieces) perimeters_.push_back(perimeter(piece.outline.points));
    const double length = median_perimeter(pieces);
    longest_ = kOtherUnit * length;
    if (!(length > 0.0)) throw InputError(pieces[0].name, "has a border of no length", "give an outline");
    for (const double samples : options_.samples) {
      std::vector<std::unique_ptr<ScaledPiece>> scaled(pieces.size());
      parallel_for(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (perimeters_[i] > longest_) continue;
          const Outline& outline = pieces[i].outline;
          const double step = length / samples;
          scaled[i] = std::make_unique<ScaledPiece>(
              ScaledPiece{PropertyPlot(outline, {step, kSmoothing, false}),
                          PropertyPlot(outline, {step, kSmoothing, true}), Silhouette(outline, step, 1.0)});
        }
      });
      scales_.push_back(std::move(scaled));
    }
  }

  PairResult match(std::size_t a, std::size_t b, const Context& context) const override {
    // The time goes with the longer border's samples at the others' steps, which would be millions.
    if (std::max(perimeters_[a], perimeters_[b]) > longest_) return {};
    // The stretches grow along the first border, and B is laid on A: the answer must not depend on which comes first.
    return shorter_first(a, b, perimeters_, [&](std::size_t first, std::size_t second) {
      return match_in_order(first, second, context);
    });
  }

 private:
  PairResult match_in_order(std::size_t a, std::size_t b, const Context& context) const {
    PairResult result;
    for (const auto& scale : scales_) {
      if (context.cancelled()) break;
      match_scale(*scale[a], *scale[b], result.candidates);
    }
    std::stable_sort(result.candidates.begin(), result.candidates.end(),
                     [](const JoinCandidate& p, const JoinCandidate& q) { return p.score > q.score; });
    keep_distinct(*scales_.back()[b], result.candidates);
    return result;
  }

  void match_scale(const ScaledPiece& a, const ScaledPiece& b, std::vector<JoinCandidate>& found) const {
    MomentOptions moment_options;
    moment_options.most = options_.moments;
    moment_options.length_weight = options_.moment_length_weight;
    moment_options.property_weight = options_.moment_property_weight;
    moment_options.colour_share = options_.colour_share;
    BoundaryOptions boundary_options;
    boundary_options.weights = {options_.length_weight, options_.property_weight, options_.colour_share};
    boundary_options.epsilon = options_.epsilon;
    const std::vector<Moment> moments = alignment_moments(a.forward, b.backward, moment_options);
    FrechetOptions frechet_options;
    frechet_options.tolerance = 0.5 * options_.epsilon *
                                (a.forward.step * static_cast<double>(a.forward.size()) +
                                 b.forward.step * static_cast<double>(b.forward.size()));
    const auto grown = [&](std::size_t moment) {
      return measure_ == Measure::Frechet
                 ? longest_frechet(a.forward, b.backward, moments[moment], frechet_options)
                 : longest_boundary(a.forward, b.backward, moments[moment], boundary_options);
    };
    // All moments by the bound of the cost, which is cheap, and the best of them by the cost itself.
    boundary_options.most_solved = 0;
    std::vector<std::pair<double, std::size_t>> order;
    order.reserve(moments.size());
    for (std::size_t i = 0; i < moments.size(); ++i) order.emplace_back(grown(i).gain, i);
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& p, const auto& q) { return p.first > q.first; });
    for (std::size_t i = 0; i < order.size() && i < kTried; ++i) {
      boundary_options.most_solved = i < kSolved ? kMostSolved : 0;
      const Stretch stretch = grown(order[i].second);
      if (stretch.a.size() < kShortest) continue;
      const JoinCandidate candidate = laid(a, b, stretch);
      if (candidate.score > 0.0) found.push_back(candidate);
    }
  }

  JoinCandidate laid(const ScaledPiece& a, const ScaledPiece& b, const Stretch& stretch) const {
    const double step = a.silhouette.step;
    JoinCandidate candidate;
    candidate.pose = aligned(a.forward, b.backward, stretch);
    candidate.pose = settle(a.silhouette, b.silhouette, candidate.pose, 2.0 * kTolerance * step, 4);
    candidate.pose = settle(a.silhouette, b.silhouette, candidate.pose, kTolerance * step, 4);
    const Contact contact = measure_contact(a.silhouette, b.silhouette, candidate.pose, kTolerance * step);
    if (contact.information <= 0.0 || contact.intrusion > kMostIntrusion * contact.length) return candidate;
    candidate.score = detail::score_of_odds((contact.information - kEvenInformation) / kInformationScale);
    candidate.boundary = boundary(a.forward, b.backward, stretch);
    if (measure_ == Measure::EarthMover) candidate.boundary = grown(a, b, candidate);
    return candidate;
  }

  static Boundary of_lengths(double begin_a, double begin_b, double length_a, double length_b) {
    return {begin_a, begin_b, 0.5 * (length_a + length_b), 0, 0, length_b - length_a};
  }

  static Boundary boundary(const PropertyPlot& a, const PropertyPlot& b, const Stretch& stretch) {
    return of_lengths(a.step * static_cast<double>(wrapped(stretch.a.front(), a.size())),
                      b.step * static_cast<double>(wrapped(-stretch.b.front(), b.size())),
                      a.step * static_cast<double>(stretch.a.back() - stretch.a.front()),
                      b.step * static_cast<double>(stretch.b.back() - stretch.b.front()));
  }

  /// The boundary as far as the borders touch at the candidate's pose: with ends that cost more than they add, without such as look alike
  /// and lie apart.
  static Boundary grown(const ScaledPiece& a, const ScaledPiece& b, const JoinCandidate& candidate) {
    const Boundary& met = candidate.boundary;
    const Silhouette& sa = a.silhouette;
    const Silhouette& sb = b.silhouette;
    const PointRun on_a = grown_run(
        sa, sb, inverse(candidate.pose), kTolerance * sa.step,
        {std::lround(met.begin_a / sa.step), std::lround((met.begin_a + met.length_a()) / sa.step)});
    const PointRun on_b = grown_run(
        sb, sa, candidate.pose, kTolerance * sa.step,
        {std::lround((met.begin_b - met.length_b()) / sb.step), std::lround(met.begin_b / sb.step)});
    return of_lengths(sa.step * static_cast<double>(wrapped(on_a.first, sa.rings[0].end)),
                      sb.step * static_cast<double>(wrapped(on_b.last, sb.rings[0].end)),
                      sa.step * static_cast<double>(on_a.last - on_a.first),
                      sb.step * static_cast<double>(on_b.last - on_b.first));
  }

  /// Drops all but the best of candidates that lay B in the same place.
  void keep_distinct(const ScaledPiece& b, std::vector<JoinCandidate>& candidates) const {
    const glm::dvec2 centre = 0.5 * (b.silhouette.low + b.silhouette.high);
    std::vector<JoinCandidate> kept;
    for (const JoinCandidate& candidate : candidates) {
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const JoinCandidate& other) {
        return angle_between(candidate.pose, other.pose) < 2.0 * kEqualTurn &&
               glm::distance(candidate.pose(centre), other.pose(centre)) < kEqualShift * b.silhouette.step;
      });
      if (!known) kept.push_back(candidate);
      if (kept.size() == options_.candidates) break;
    }
    candidates = std::move(kept);
  }

  EmdOptions options_;
  Measure measure_;
  std::vector<std::vector<std::unique_ptr<ScaledPiece>>> scales_;
  std::vector<double> perimeters_;
  double longest_ = 0.0;  ///< of a border that is compared, file units
};

}  // namespace

std::unique_ptr<Matcher> make_emd(const EmdOptions& options) {
  return std::make_unique<EmdMatcher>(options, Measure::EarthMover);
}

std::unique_ptr<Matcher> make_frechet(const EmdOptions& options) {
  return std::make_unique<EmdMatcher>(options, Measure::Frechet);
}

}  // namespace rejoin::outline
