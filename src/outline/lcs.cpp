#include "outline/lcs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/median.hpp"
#include "outline/detail/lcs_scale.hpp"

namespace rejoin::outline {
namespace {

using detail::LcsFit;
using detail::LcsScale;

constexpr std::size_t kLongest = 12000;     // a border; longer ones are sampled more coarsely
constexpr std::size_t kLeastSamples = 300;  // of a set's mean border
constexpr double kCoarser = 3.0;            // a scale's step / that of the one before

double median_spacing(const std::vector<Piece>& pieces) {
  std::vector<double> spacings;
  spacings.reserve(pieces.size());
  for (const Piece& piece : pieces)
    spacings.push_back(perimeter(piece.outline.points) / static_cast<double>(piece.outline.points.size()));
  return median(spacings);
}

/// As the files' points lie, within what can be told apart and what can be compared in time.
double step_of(const std::vector<Piece>& pieces, double wanted) {
  double longest = 0.0;
  double sum = 0.0;
  for (const Piece& piece : pieces) {
    longest = std::max(longest, perimeter(piece.outline.points));
    sum += perimeter(piece.outline.points);
  }
  const double mean = sum / static_cast<double>(pieces.size());
  const double step = wanted > 0.0 ? wanted : std::min(median_spacing(pieces), mean / kLeastSamples);
  return std::max(step, longest / kLongest);
}

class LcsMatcher final : public Matcher {
 public:
  explicit LcsMatcher(const LcsOptions& options) : options_(options) {
    if (options.window < 5 || options.window > 201 || options.window % 2 == 0)
      throw InputError("window", fmt::format("{} samples", options.window),
                       "give an odd number from 5 to 201");
    if (!(options.match_deg > 0.0) || !(options.straight_deg >= 0.0) || !(options.confidence > 0.0))
      throw InputError("lcs", "a tolerance is not positive", "give positive numbers");
    if (options.scales < 1 || options.scales > 4)
      throw InputError("scales", fmt::format("{} scales", options.scales), "give 1 to 4");
  }

  void prepare(const std::vector<Piece>& pieces) override {
    scales_.clear();
    ends_.clear();
    perimeters_.clear();
    if (pieces.empty()) return;
    for (const Piece& piece : pieces) {
      if (piece.outline.points.size() < 3 || !(perimeter(piece.outline.points) > 0.0))
        throw InputError(piece.name, "the piece has no border", "leave it out");
    }
    double step = step_of(pieces, options_.step);
    scales_.reserve(static_cast<std::size_t>(options_.scales));
    for (int k = 0; k < options_.scales; ++k, step *= kCoarser) scales_.emplace_back(pieces, options_, step);
    ends_.reserve(pieces.size());
    perimeters_.reserve(pieces.size());
    for (const Piece& piece : pieces) {
      perimeters_.push_back(perimeter(piece.outline.points));
      ends_.push_back({piece.outline.points.front(), piece.outline.points[piece.outline.points.size() / 2]});
    }
  }

  PairResult match(std::size_t a, std::size_t b, const Context& context) const override {
    // B is laid on A, which keeps its samples: the answer must not depend on which comes first.
    return shorter_first(a, b, perimeters_, [&](std::size_t first, std::size_t second) {
      return match_in_order(first, second, context);
    });
  }

 private:
  PairResult match_in_order(std::size_t a, std::size_t b, const Context& context) const {
    std::vector<LcsFit> found;
    for (const LcsScale& scale : scales_) {
      const std::size_t before = found.size();
      scale.search(a, b, context, found);
      const std::size_t after = found.size();
      if (&scale == &scales_.front()) continue;
      for (std::size_t k = before; k < after && !context.cancelled(); ++k)
        if (auto finer = scales_.front().refine(a, b, found[k], scale.step())) found.push_back(*finer);
    }
    return distinct(std::move(found), ends_[b]);
  }

  /// Best first; a pose that lays B's ends nearly where a better one does is the same.
  PairResult distinct(std::vector<LcsFit> found, const std::pair<glm::dvec2, glm::dvec2>& ends) const {
    std::stable_sort(found.begin(), found.end(),
                     [](const LcsFit& x, const LcsFit& y) { return x.evidence > y.evidence; });
    const double same = 0.5 * options_.window * scales_.front().step();
    PairResult result;
    for (const LcsFit& fitted : found) {
      if (result.candidates.size() == static_cast<std::size_t>(options_.candidates)) break;
      const Planar& pose = fitted.join.pose;
      const bool known =
          std::any_of(result.candidates.begin(), result.candidates.end(), [&](const JoinCandidate& other) {
            return other.pose.flipped == pose.flipped &&
                   glm::distance(other.pose(ends.first), pose(ends.first)) < same &&
                   glm::distance(other.pose(ends.second), pose(ends.second)) < same;
          });
      if (!known) result.candidates.push_back(fitted.join);
    }
    return result;
  }

  LcsOptions options_;
  std::vector<LcsScale> scales_;                         ///< finest first
  std::vector<std::pair<glm::dvec2, glm::dvec2>> ends_;  ///< two points of each piece far from each other
  std::vector<double> perimeters_;
};

}  // namespace

std::unique_ptr<Matcher> make_lcs(const LcsOptions& options) {
  return std::make_unique<LcsMatcher>(options);
}

}  // namespace rejoin::outline
