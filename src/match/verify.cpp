#include "match/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "match/esa_search.hpp"
#include "match/pose_space.hpp"

namespace rejoin::match {
namespace {

constexpr double kSteady = 2.0;     // degrees between the poses of either half of the samples, at most
constexpr double kSlope = 0.75;     // strength that multiplies the odds by e
constexpr double kAhead = 11.0;     // log-odds of a sure join over those of the pair's next pose, at least
constexpr double kNext = 0.8;       // of the strength of a sure join, that of the pair's next pose, at most
constexpr double kRounding = 1e-6;  // strength: what at_most_even() held back has kEven
constexpr double kLike = 0.5;       // of its strength, what it leaves at most farther along
constexpr double kLikely = 0.5;     // score from which the shape speaks for a join
constexpr double kHeld = 0.6;  // of the distance between two pushed poses, what a sure join leaves at most

/// Whether the pair's next pose comes near: of large joints equal poses differ by more than kAhead by chance.
bool has_rival(const Stability& stability) {
  return stability.margin < kAhead || stability.next_share > kNext;
}

std::string told_rival(const Stability& stability) {
  if (stability.next_share > kNext) return "another pose of the two is nearly as good";
  return fmt::format("another pose of the two is {:.2f} behind in log-odds, and {:.0f} are asked for a join",
                     stability.margin, kAhead);
}

/// Why a pose is no likelier, for users.
std::string told_doubt(const Evidence& evidence) {
  switch (evidence.doubt) {
    case Doubt::Walls:
      return "what touches has nothing behind it in either scan: it may be walls";
    case Doubt::Loose:
      return "much of what lies on the other piece does not touch it, and hardly any skin goes on beside it";
    case Doubt::Faint:
      return "of each part of the break hardly any shape agrees: its size alone speaks for it";
    case Doubt::Drift:
      return fmt::format(
          "the gap drifts over the break, by {:.2g}, and the scans stray by less: these are alike, or worn",
          evidence.drift_spread);
    case Doubt::Slide:
      return "one piece slides along the other: nothing holds it there";
    case Doubt::None:
      break;
  }
  return {};
}

/// Not shifted but by a part of a pixel, so that as many pixels are covered as if nothing were cut off at the view's sides.
zbuffer::ViewPair with_a_in_view(zbuffer::ViewPair view, const zbuffer::ViewOptions& options) {
  const float pixel = static_cast<float>(options.view_side) / static_cast<float>(options.resolution);
  view.shift_a -= pixel * glm::round(view.shift_a / pixel);
  return view;
}

}  // namespace

double log_odds(double strength) {
  return (strength - kEven) / kSlope;
}

double score_of(double strength) {
  return 1.0 / (1.0 + std::exp(-log_odds(strength)));
}

bool slides(const Stability& stability) {
  return stability.slide > kHeld || stability.elsewhere > kLike;
}

Verdict verdict_of(double score, const std::optional<Stability>& stability) {
  const bool holds = stability && stability->repeat_deg <= kSteady && !has_rival(*stability);
  if (score >= kSure && holds) return Verdict::Join;
  return score >= kPossible ? Verdict::Unsure : Verdict::NoJoin;
}

std::string against(const Evidence& evidence, double score, const std::optional<Stability>& stability) {
  if (verdict_of(score, stability) == Verdict::Join) return {};
  if (score >= kSure) {
    if (!stability) return "it was not looked at whether the pose holds";
    if (has_rival(*stability)) return told_rival(*stability);
    return fmt::format("either half of the break turns the pose by {:.1f} degrees", stability->repeat_deg);
  }
  const bool held_back = evidence.doubt != Doubt::None && std::abs(strength(evidence) - kEven) < kRounding;
  if (held_back || evidence.doubt == Doubt::Slide) return told_doubt(evidence);
  std::string found = objection(evidence);
  if (!found.empty()) return found;
  return score < kLikely ? "the breaks have too little shape in common"
                         : "the breaks have shape in common, but too little to be sure";
}

Candidate unmeasured(const Fragment& a, const Fragment& b, const Rigid& pose, const Evidence& evidence,
                     double strength) {
  Candidate c;
  c.pose = to_files(a, b, pose);
  c.score = score_of(strength);
  c.slides = evidence.doubt == Doubt::Slide;
  c.error.contact_area = evidence.contact_area;
  c.error.gap_median = evidence.gap_median;
  const double over = std::max(evidence.contact_area, evidence.penetration_area);
  if (over > 0) c.error.penetration = evidence.penetration * evidence.penetration_area / over;
  return c;
}

Verifier::Verifier(const Fragment& a, const Fragment& b, const Options& options)
    : a_(a), b_(b), view_(whole_fragment_view(a, b, options.resolution)) {
  raster_ = zbuffer::make_scorer(options.backend, a.coarse, b.coarse, view_);
}

Candidate Verifier::candidate(const Rigid& pose, const Evidence& evidence, double strength) {
  Candidate c = unmeasured(a_, b_, pose, evidence, strength);
  const glm::dvec3 direction = glm::length(evidence.normal) > 0 ? evidence.normal : glm::dvec3(0, 0, 1);
  const ViewCentres centres{a_.surface.origin + glm::dvec3(view_.centre_a),
                            b_.surface.origin + glm::dvec3(view_.centre_b)};
  c.view = facing_view(c.pose, direction, centres).view;
  const std::array views{c.view, with_a_in_view(c.view, view_)};
  std::array<zbuffer::PairScore, 2> scores;
  raster_->score(views, scores);
  c.error.depth = static_cast<double>(scores[0].error);
  c.error.slope = c.error.depth * view_.resolution;
  const int covered = std::min(scores[1].covered_a, scores[0].covered_b);
  c.error.overlap = covered > 0 ? static_cast<double>(scores[0].overlap) / covered : 0.0;
  if (!raycast_) raycast_ = zbuffer::make_scorer(zbuffer::Backend::RayCast, a_.surface, b_.surface, view_);
  raycast_->score(std::span(views).first(1), std::span(scores).first(1));
  c.error.raycast = static_cast<double>(scores[0].error) * view_.resolution;
  return c;
}

}  // namespace rejoin::match
