#include "outline/join_fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/median.hpp"
#include "core/parallel.hpp"
#include "outline/detail/closest.hpp"
#include "outline/detail/coding.hpp"
#include "outline/detail/distance_grid.hpp"
#include "outline/detail/evidence.hpp"
#include "outline/detail/odds.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

/// Poses are fitted on the border at this scale: its noise is gone, its shape is not.
constexpr std::size_t kFitScale = 1;
/// Of the tolerance: what lies deeper is told by depths that are accurate to about a cell.
constexpr double kCell = 0.5;
/// Borders may be off each other by this many steps of the fit's scale.
constexpr double kToleranceSteps = 3.0;
/// Turning beyond this many times the usual is cut off.
constexpr double kTurningLimit = 4.0;
/// Overlap that costs a factor e of evidence, share of the smaller piece.
constexpr double kOverlapScale = 0.03;
/// The same as a mean depth along the boundary, tolerances.
constexpr double kOverlapDepth = 0.5;
/// The residual that costs a factor e of evidence, tolerances.  A true join's two sides keep their distance (worn edges too);
/// where the borders only happen to run the same way, it varies by as much as the tolerance lets through.
constexpr double kResidual = 0.3;
/// The automatic step leaves at most this many samples on the mean border.
constexpr double kMostSamples = 3000.0;
constexpr double kStepInEdges = 1.4;
/// Outlines that were simplified have points where they bend and long edges between, a tenth of them this much longer than the median:
/// how far apart the points lie says nothing of how exact they are.  Where noise alone makes edges uneven it is 1.82 (Rayleigh).
constexpr double kLongEdges = 0.9;
constexpr double kUneven = 1.9;
constexpr double kStepOfSimplified = 2.0;  // the finest steps
constexpr double kSameAngle = 5.0 * M_PI / 180.0;
/// See score_of().
constexpr double kEvenEvidence = 17.0;
constexpr double kEvidenceScale = 3.0;

/// The place on a closed border.
double wrapped_place(double place, double perimeter) {
  return place - std::floor(place / perimeter) * perimeter;
}

}  // namespace

double automatic_step(const std::vector<Piece>& pieces) {
  std::vector<double> edges;
  double length = 0.0;
  std::size_t simplified = 0;
  for (const Piece& piece : pieces) {
    const std::vector<double> lengths = arc_lengths(piece.outline.points);
    length += lengths.back();
    std::vector<double> own;
    for (std::size_t i = 0; i + 1 < lengths.size(); ++i) own.push_back(lengths[i + 1] - lengths[i]);
    edges.insert(edges.end(), own.begin(), own.end());
    if (!piece.outline.of_pixels && quantile(own, kLongEdges) > kUneven * median(own)) ++simplified;
  }
  const double finest = length / static_cast<double>(pieces.size()) / kMostSamples;
  const double usual = std::max(kStepInEdges * median(edges), finest);
  return 2 * simplified > pieces.size() ? std::min(usual, kStepOfSimplified * finest) : usual;
}

struct JoinFitter::State {
  std::vector<BorderName> borders;
  std::vector<std::vector<ScaleSignal>> scales;  ///< of each border
  std::vector<double> perimeters;                ///< the same
  std::vector<double> areas;                     ///< of each piece
  std::vector<detail::Pixels> pixels;            ///< the same
  std::vector<detail::DistanceGrid> grids;
  std::vector<double> limits;  ///< of each scale
  double step = 0.0;
  double tolerance = 0.0;

  detail::ScaledBorder border(std::size_t number) const {
    return {&scales[number],
            &limits,
            {&scales[number][kFitScale], perimeters[number]},
            pixels[borders[number].piece]};
  }

  void find_limits() {
    const auto outer = std::span(scales).first(areas.size());
    const bool of_pixels = std::ranges::any_of(pixels, &detail::Pixels::any);
    for (std::size_t k = 0; k < scales[0].size(); ++k)
      limits.push_back(kTurningLimit * detail::usual_turning(outer, k, of_pixels));
  }

  /// About the area that lies deeper than the tolerance in both; depths are too rough for what is less deep.
  double deep_overlap(std::size_t a, std::size_t b, const Planar& pose) const {
    const bool a_smaller = areas[a] < areas[b];
    const detail::DistanceGrid& moved = grids[a_smaller ? a : b];
    const detail::DistanceGrid& other = grids[a_smaller ? b : a];
    const Motion motion(a_smaller ? inverse(pose) : pose);
    double deep = 0.0;
    for (const glm::dvec2& p : moved.inside()) {
      const double depth = other.depth(motion(p));
      if (depth <= tolerance) continue;
      if (std::min(depth, moved.depth(p)) > tolerance) deep += 1.0;
    }
    return deep * moved.area_of_place();
  }
};

JoinFitter::JoinFitter(const std::vector<Piece>& pieces, const FitOptions& options)
    : state_(std::make_unique<State>()) {
  for (const Piece& piece : pieces) {
    if (piece.outline.points.size() < 4) throw InputError(piece.name, "has no border", "give an outline");
  }
  State& s = *state_;
  s.step = options.step > 0.0 ? options.step : automatic_step(pieces);
  s.tolerance = options.tolerance > 0.0 ? options.tolerance : kToleranceSteps * 2.0 * s.step;
  const std::size_t count = pieces.size();
  for (std::size_t i = 0; i < count; ++i) s.borders.push_back({i, 0});
  for (std::size_t i = 0; i < count; ++i)
    for (const std::size_t hole : long_borders(pieces[i].outline, options.shortest_hole))
      if (hole > 0) s.borders.push_back({i, hole});
  s.scales.resize(s.borders.size());
  s.perimeters.resize(s.borders.size());
  s.areas.resize(count);
  for (const Piece& piece : pieces) s.pixels.push_back({piece.outline.of_pixels, piece.outline.raster});
  std::vector<std::optional<detail::DistanceGrid>> grids(count);
  const int scales = std::max(options.scales, static_cast<int>(kFitScale) + 1);
  parallel_for(s.borders.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto& [piece, hole] = s.borders[i];
      const std::vector<glm::dvec2>& border = border_of(pieces[piece].outline, hole);
      s.scales[i] = scale_space(border, {s.step, scales});
      s.perimeters[i] = perimeter(border);
      if (hole > 0) continue;
      s.areas[piece] = signed_area(border);
      grids[piece].emplace(pieces[piece].outline, kCell * s.tolerance);
    }
  });
  s.grids.reserve(count);
  for (auto& grid : grids) s.grids.push_back(std::move(*grid));
  s.find_limits();
}

JoinFitter::~JoinFitter() = default;
JoinFitter::JoinFitter(JoinFitter&&) noexcept = default;
JoinFitter& JoinFitter::operator=(JoinFitter&&) noexcept = default;

double JoinFitter::step() const {
  return state_->step;
}

const std::vector<BorderName>& JoinFitter::borders() const {
  return state_->borders;
}

std::optional<FittedJoin> JoinFitter::fit(std::size_t a, std::size_t b,
                                          const std::vector<PairedPlaces>& pairs) const {
  const State& s = *state_;
  const detail::ScaledBorder border_a = s.border(a);
  const detail::ScaledBorder border_b = s.border(b);
  const auto contact = detail::fit_contact(border_a.border, border_b.border, pairs, s.tolerance);
  if (!contact) return std::nullopt;
  FittedJoin fitted;
  JoinCandidate& join = fitted.join;
  join.pose = contact->pose;
  fitted.residual = contact->residual;
  const double begin_a = detail::place_of(border_a.border, contact->contacts.front().i);
  const double end_a = detail::place_of(border_a.border, contact->contacts.back().i);
  const double begin_b = detail::place_of(border_b.border, contact->contacts.front().j);
  const double end_b = detail::place_of(border_b.border, contact->contacts.back().j);
  join.boundary.begin_a = wrapped_place(begin_a, s.perimeters[a]);
  join.boundary.begin_b = wrapped_place(begin_b, s.perimeters[b]);
  join.boundary.length = 0.5 * (end_a - begin_a + begin_b - end_b);
  join.boundary.longer_b = begin_b - end_b - (end_a - begin_a);
  const auto& [piece_a, hole_a] = s.borders[a];
  const auto& [piece_b, hole_b] = s.borders[b];
  join.boundary.hole_a = hole_a;
  join.boundary.hole_b = hole_b;
  const double overlap = s.deep_overlap(piece_a, piece_b, join.pose);
  fitted.overlap_share = overlap / std::min(s.areas[piece_a], s.areas[piece_b]);
  const double along_boundary = overlap / (s.tolerance * join.boundary.length);
  const double residual = fitted.residual / (kResidual * s.tolerance);
  fitted.evidence =
      detail::agreement(border_a, border_b, contact->contacts) *
      std::exp(-residual * residual - fitted.overlap_share / kOverlapScale - along_boundary / kOverlapDepth);
  join.score = score_of(fitted.evidence);
  fitted.pairs.reserve(contact->contacts.size());
  for (const detail::Contact& c : contact->contacts)
    fitted.pairs.push_back({detail::place_of(border_a.border, c.i), detail::place_of(border_b.border, c.j)});
  return fitted;
}

FittedJoin JoinFitter::exchanged(std::size_t a, std::size_t b, const FittedJoin& join) const {
  FittedJoin result = join;
  result.pairs.clear();
  for (auto pair = join.pairs.rbegin(); pair != join.pairs.rend(); ++pair)
    result.pairs.push_back({pair->on_b, pair->on_a});
  result.join.pose = inverse(join.join.pose);
  Boundary& boundary = result.join.boundary;
  boundary.begin_a = wrapped_place(result.pairs.front().on_a, state_->perimeters[b]);
  boundary.begin_b = wrapped_place(result.pairs.front().on_b, state_->perimeters[a]);
  std::swap(boundary.hole_a, boundary.hole_b);
  boundary.longer_b = -boundary.longer_b;
  return result;
}

FittedJoin JoinFitter::fit_from_both_sides(std::size_t a, std::size_t b, const FittedJoin& join) const {
  const auto back = fit(b, a, exchanged(a, b, join).pairs);
  const double evidence = back ? back->evidence : 0.0;
  FittedJoin result = evidence > join.evidence ? exchanged(b, a, *back) : join;
  result.evidence = 0.5 * (join.evidence + evidence);
  result.join.score = score_of(result.evidence);
  return result;
}

std::vector<FittedJoin> distinct(std::vector<FittedJoin> joins, const Piece& b, double same_distance,
                                 std::size_t most) {
  std::stable_sort(joins.begin(), joins.end(),
                   [](const FittedJoin& x, const FittedJoin& y) { return x.evidence > y.evidence; });
  std::vector<FittedJoin> kept;
  const auto off = [&](const Planar& x, const Planar& y) {
    double farthest = 0.0;
    const std::size_t stride = std::max<std::size_t>(1, b.outline.points.size() / 16);
    for (std::size_t i = 0; i < b.outline.points.size(); i += stride)
      farthest = std::max(farthest, glm::distance(x(b.outline.points[i]), y(b.outline.points[i])));
    return farthest;
  };
  for (FittedJoin& fitted : joins) {
    if (kept.size() == most) break;
    const auto same = [&](const FittedJoin& other) {
      return angle_between(other.join.pose, fitted.join.pose) < kSameAngle &&
             off(other.join.pose, fitted.join.pose) < same_distance;
    };
    if (std::none_of(kept.begin(), kept.end(), same)) kept.push_back(std::move(fitted));
  }
  return kept;
}

double score_of(double evidence) {
  return detail::score_of_odds((evidence - kEvenEvidence) / kEvidenceScale);
}

}  // namespace rejoin::outline
