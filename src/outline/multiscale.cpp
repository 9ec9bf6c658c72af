#include "outline/multiscale.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.hpp"
#include "outline/detail/closest.hpp"
#include "outline/detail/coding.hpp"
#include "outline/detail/pairing.hpp"
#include "outline/join_fit.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

constexpr int kMostScales = 7;
/// Poses of one pair that differ by less than this share of the smaller border are one.
constexpr double kSamePose = 0.02;
constexpr std::size_t kReported = 10;
/// The search begins at coarser scales too, up to that at which a boundary of this share of the mean border is not yet lost:
/// where the fine scales hold nothing but noise, a long boundary shows at the coarse ones alone.
constexpr double kLongBoundary = 1.0 / 3.0;
constexpr int kLeastAtScale = 3;
/// Area of a piece that may lie in a hole, as a share of the hole's: a scan takes a little off one and adds it to the other.
constexpr double kHoleSlack = 1.25;

class Multiscale final : public Matcher {
 public:
  explicit Multiscale(const MultiscaleOptions& options) : options_(options) {}

  void prepare(const std::vector<Piece>& pieces) override {
    pieces_ = &pieces;
    double mean = 0.0;
    for (const Piece& piece : pieces)
      mean += perimeter(piece.outline.points) / static_cast<double>(pieces.size());
    min_length_ = options_.min_length > 0.0 ? options_.min_length : options_.min_length_share * mean;
    FitOptions fit;
    fit.step = options_.step;
    fit.shortest_hole = min_length_;
    fitter_.emplace(pieces, fit);
    const double step = fitter_->step();
    scales_ = count_scales(step, min_length_);
    all_scales_ = std::max(scales_, count_scales(step, kLongBoundary * mean));
    name_borders();
    signals_.assign(borders_.size(), {});
    parallel_for(borders_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) signals_[i] = scale_space(*borders_[i], {step, all_scales_});
    });
    encode_all();
  }

  PairResult match(std::size_t a, std::size_t b, const Context& context) const override {
    // The search and the fits go along the first border, so the order decides what is found; the answer must not depend on it.
    const bool exchange = perimeters_[b] < perimeters_[a];
    std::vector<FittedJoin> joins = exchange ? joins_of(b, a, context) : joins_of(a, b, context);
    PairResult result;
    result.candidates.reserve(joins.size());
    for (const FittedJoin& fitted : joins)
      result.candidates.push_back(exchange ? exchanged(b, a, fitted).join : fitted.join);
    return result;
  }

 private:
  void name_borders() {
    borders_.clear();
    perimeters_.clear();
    holes_.assign(pieces_->size(), {});
    for (const auto& [piece, hole] : fitter_->borders()) {
      if (hole > 0) holes_[piece].push_back(borders_.size());
      borders_.push_back(&outline::border_of((*pieces_)[piece].outline, hole));
      perimeters_.push_back(perimeter(*borders_.back()));
    }
  }

  /// The places where b joins a, best first.
  std::vector<FittedJoin> joins_of(std::size_t a, std::size_t b, const Context& context) const {
    std::vector<FittedJoin> joins;
    add_joins(a, b, context, joins);
    for (const std::size_t hole : holes_[a])
      if (may_lie_in(b, hole)) add_joins(hole, b, context, joins);
    for (const std::size_t hole : holes_[b])
      if (may_lie_in(a, hole)) add_joins(a, hole, context, joins);
    const double same = kSamePose * std::min(perimeters_[a], perimeters_[b]);
    joins = distinct(std::move(joins), (*pieces_)[b], same, kReported);
    for (FittedJoin& fitted : joins) {
      const Boundary& boundary = fitted.join.boundary;
      fitted =
          fitter_->fit_from_both_sides(border_of(a, boundary.hole_a), border_of(b, boundary.hole_b), fitted);
    }
    return distinct(std::move(joins), (*pieces_)[b], same, kReported);
  }

  FittedJoin exchanged(std::size_t a, std::size_t b, const FittedJoin& fitted) const {
    const Boundary& boundary = fitted.join.boundary;
    return fitter_->exchanged(border_of(a, boundary.hole_a), border_of(b, boundary.hole_b), fitted);
  }

  /// A piece's border among all borders.
  std::size_t border_of(std::size_t piece, std::size_t hole) const {
    if (hole == 0) return piece;
    return *std::find_if(holes_[piece].begin(), holes_[piece].end(),
                         [&](std::size_t border) { return fitter_->borders()[border].hole == hole; });
  }

  /// Whether a piece is small enough for a hole.
  bool may_lie_in(std::size_t piece, std::size_t hole) const {
    return signed_area(*borders_[piece]) <= -kHoleSlack * signed_area(*borders_[hole]);
  }

  void add_joins(std::size_t a, std::size_t b, const Context& context, std::vector<FittedJoin>& joins) const {
    for (const auto& start : search(a, b, context)) {
      if (context.cancelled()) return;
      auto fitted = fitter_->fit(a, b, start);
      if (fitted) joins.push_back(*fitted);
    }
  }

  /// K: scales down to which a boundary of L_min is not yet lost to blurred corners.
  int count_scales(double step, double min_length) const {
    int scales = 1;
    while (scales < kMostScales && 2.0 * step * (1.0 + 8.0 * options_.alpha) <= min_length) {
      step *= 2.0;
      ++scales;
    }
    return scales;
  }

  void encode_all() {
    coded_.assign(signals_.size(), {});
    for (std::size_t k = 0; k < static_cast<std::size_t>(all_scales_); ++k) {
      const double usual =
          detail::usual_turning(std::span(signals_).first(pieces_->size()), k, any_of_pixels(*pieces_));
      for (std::size_t i = 0; i < signals_.size(); ++i)
        coded_[i].push_back(detail::encode(signals_[i][k], usual));
    }
  }

  detail::ScaleParameters parameters(std::size_t k) const {
    const MultiscaleLevel level = k < options_.levels.size() ? options_.levels[k] : default_level();
    return {level.xi, level.zeta, level.n_min};
  }

  detail::Sequences sequences(std::size_t a, std::size_t b, std::size_t k) const {
    return {&coded_[a][k].forward, &coded_[b][k].backward};
  }

  /// Position in B's backward sequence <-> place on B's border.
  double place_on_b(std::size_t b, std::size_t k, double j) const {
    const detail::Border border{&signals_[b][k], perimeters_[b]};
    return detail::place_of(border, static_cast<double>(border.signal->points.size()) - 1.0 - j);
  }
  double sample_on_b(std::size_t b, std::size_t k, double place) const {
    const detail::Border border{&signals_[b][k], perimeters_[b]};
    return static_cast<double>(border.signal->points.size()) - 1.0 - detail::sample_of(border, place);
  }

  std::vector<PairedPlaces> places(std::size_t a, std::size_t b, std::size_t k,
                                   const detail::Candidate& candidate) const {
    const detail::Border border_a{&signals_[a][k], perimeters_[a]};
    std::vector<PairedPlaces> result;
    result.reserve(candidate.path.size());
    for (const detail::PairedSamples& p : candidate.path)
      result.push_back({detail::place_of(border_a, p.i), place_on_b(b, k, p.j)});
    return result;
  }

  /// A candidate's pairing at the next finer scale, with its ends moved out by what blurring had taken.
  std::vector<detail::PairedSamples> mapped(std::size_t a, std::size_t b, std::size_t k,
                                            const detail::Candidate& candidate) const {
    const detail::Border border_a{&signals_[a][k - 1], perimeters_[a]};
    std::vector<detail::PairedSamples> path;
    for (const PairedPlaces& p : places(a, b, k, candidate)) {
      path.push_back({static_cast<std::int32_t>(std::lround(detail::sample_of(border_a, p.on_a))),
                      static_cast<std::int32_t>(std::lround(sample_on_b(b, k - 1, p.on_b)))});
    }
    // alpha (lambda^(k+1) - lambda^(k)) in samples of the finer scale, where lambda = 4 delta.
    const auto more = static_cast<std::int32_t>(std::lround(4.0 * options_.alpha));
    const auto front = path.front();
    const auto back = path.back();
    path.insert(path.begin(), {front.i - more, front.j - more});
    path.push_back({back.i + more, back.j + more});
    return path;
  }

  /// Algorithm 1.  Candidates that a finer scale rejects are kept as they were at the coarser one, behind the rest: wear may
  /// have taken the fine scales.
  std::vector<std::vector<PairedPlaces>> search(std::size_t a, std::size_t b, const Context& context) const {
    auto k = static_cast<std::size_t>(scales_) - 1;
    const std::size_t finest = options_.per_pair;
    const int least =
        std::max(kLeastAtScale, static_cast<int>(min_length_ / signals_[a][k].step - 8.0 * options_.alpha));
    std::vector<detail::Candidate> candidates =
        detail::initial_candidates(sequences(a, b, k), parameters(k), least, finest << k);
    std::vector<std::vector<PairedPlaces>> rejected;
    while (k > 0 && !context.cancelled()) {
      std::vector<detail::Candidate> refined;
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        detail::Candidate next = detail::refine(sequences(a, b, k - 1), parameters(k - 1),
                                                mapped(a, b, k, candidates[c]), options_.band);
        if (next.discriminant < 0.0) {
          refined.push_back(std::move(next));
        } else {
          rejected.push_back(places(a, b, k, candidates[c]));
        }
      }
      --k;
      const std::size_t most = finest << k;
      detail::prune_and_merge(refined, signals_[a][k].points.size(), signals_[b][k].points.size(), most);
      candidates = std::move(refined);
    }
    std::vector<std::vector<PairedPlaces>> starts;
    starts.reserve(candidates.size() + rejected.size());
    for (const detail::Candidate& candidate : candidates) starts.push_back(places(a, b, k, candidate));
    for (auto late = rejected.rbegin(); late != rejected.rend() && starts.size() < options_.fitted; ++late)
      starts.push_back(std::move(*late));
    if (starts.size() > options_.fitted) starts.resize(options_.fitted);
    for (auto coarse = scales_; coarse < all_scales_ && !context.cancelled(); ++coarse)
      add_coarse(a, b, static_cast<std::size_t>(coarse), starts);
    return starts;
  }

  /// The best candidates of a scale at which short boundaries are lost, each refined as long as finer scales say more of it.
  void add_coarse(std::size_t a, std::size_t b, std::size_t scale,
                  std::vector<std::vector<PairedPlaces>>& starts) const {
    for (detail::Candidate& candidate : detail::initial_candidates(
             sequences(a, b, scale), parameters(scale), kLeastAtScale, options_.per_coarse_scale)) {
      std::size_t k = scale;
      while (k > 0) {
        detail::Candidate next = detail::refine(sequences(a, b, k - 1), parameters(k - 1),
                                                mapped(a, b, k, candidate), options_.band);
        if (next.discriminant >= candidate.discriminant) break;
        candidate = std::move(next);
        --k;
      }
      starts.push_back(places(a, b, k, candidate));
    }
  }

  MultiscaleOptions options_;
  const std::vector<Piece>* pieces_ = nullptr;
  std::optional<JoinFitter> fitter_;
  // Of each border, as JoinFitter::borders() has them: the pieces' outer ones come first, each at its piece's position.
  std::vector<const std::vector<glm::dvec2>*> borders_;
  std::vector<double> perimeters_;
  std::vector<std::vector<std::size_t>> holes_;  ///< of each piece: positions among the borders
  double min_length_ = 0.0;
  int scales_ = 1;      ///< K, from L_min
  int all_scales_ = 1;  ///< with the coarser ones
  std::vector<std::vector<ScaleSignal>> signals_;
  std::vector<std::vector<detail::Coded>> coded_;
};

}  // namespace

MultiscaleLevel default_level() {
  return {1.2, 1.8, 5.0};
}

std::unique_ptr<Matcher> make_multiscale(const MultiscaleOptions& options) {
  return std::make_unique<Multiscale>(options);
}

}  // namespace rejoin::outline
