/// What the evidence of a joint is worth, and what is held against it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "match/detail/worth.hpp"
#include "match/evidence.hpp"

namespace rejoin::match {
namespace {

constexpr double kLoose = 0.5;         // gap spread, in tolerances, that halves what a joint is worth
constexpr double kOpenCosts = 4.0;     // exponent of the share that touches
constexpr double kContact = 0.2;       // nats that a touching patch is worth among poses of one pair
constexpr double kMostPatches = 16.0;  // more contact than this says no more
constexpr double kWallsGoOn = 0.8;     // share of the walls that go on across a true seam, at least
constexpr double kByChance = 4.0;      // patches of skin that go on at wrong poses, too
constexpr double kContinuation = 0.5;  // strength of every further patch
constexpr double kMostContinuation = 4.5;
constexpr double kSmallestShare = 0.4;  // of the information, by scales: right poses have as much
constexpr double kDrift = 1.25;         // of sides of one break at most, if the scans are true
constexpr double kDrifting =
    0.6;  // of the information, what is left where gaps are alike over several patches
constexpr double kNearCosts = 6.0;  // strength: within kNear tolerances more fits by chance
constexpr double kNearPart = 0.6;   // of what counts there, at most: of exact scans the tolerance decides
constexpr double kHalf = 0.5;       // of the shape's worth: what takes that is told

/// Of what lies over the other surface or inside the other body, the share that touches.
/// \param touching, shared  areas
double share_of(double touching, double shared, const Evidence& evidence) {
  const double all = shared + evidence.penetration_area;
  return all > 0 ? touching / all : 0.0;
}

/// What leaves of the shape's information what it is worth, each 0 to 1.
struct Reserves {
  double touching;  ///< by what lies over the other surface or in the other body without touching it
  double walls;     ///< by walls that do not go on
  double tight;     ///< by gaps that vary

  double left() const { return touching * walls * tight; }
};

/// \param touching   share of what lies over the other surface that touches within the tolerance
/// \param tolerance  above 0
Reserves reserves_within(double touching, double tolerance, const Evidence& evidence) {
  const double loose = evidence.gap_spread / (kLoose * tolerance);
  const double walls = std::min(1.0, evidence.wall_share / kWallsGoOn);
  return {std::pow(touching, kOpenCosts), walls * walls, 1.0 / (1.0 + loose * loose * loose * loose)};
}

/// \pre the tolerance is above 0
Reserves reserves_of(const Evidence& evidence) {
  return reserves_within(touching_share(evidence), evidence.tolerance, evidence);
}

/// The geometric mean, of what is above 0.
double mean_of(double there, double back) {
  return std::sqrt(std::max(0.0, there) * std::max(0.0, back));
}

}  // namespace

namespace detail {

double Worth::strength() const {
  return std::max(close, std::min(near - kNearCosts, kNearPart * near));
}

Worth worth_of(const Evidence& evidence) {
  if (touching_share(evidence) <= 0 || evidence.tolerance <= 0) return {};
  const double near_share = share_of(evidence.near_contact_area, evidence.near_shared_area, evidence);
  const Reserves near = reserves_within(near_share, kNear * evidence.tolerance, evidence);
  return {evidence.information * reserves_of(evidence).left(), evidence.near_information * near.left()};
}

Worth agreed(const Worth& there, const Worth& back) {
  return {mean_of(there.close, back.close), mean_of(there.near, back.near)};
}

double most_of_skin(const Evidence& evidence) {
  return kMostContinuation * std::pow(touching_share(evidence), kOpenCosts);
}

}  // namespace detail

double touching_share(const Evidence& evidence) {
  return share_of(evidence.contact_area, evidence.shared_area, evidence);
}

double strength(const Evidence& evidence) {
  const double further = std::max(0.0, evidence.continuation - kByChance);
  const double skin =
      std::min(kMostContinuation, kContinuation * further) * std::pow(touching_share(evidence), kOpenCosts);
  return detail::worth_of(evidence).strength() + skin;
}

std::string objection(const Evidence& evidence) {
  if (evidence.tolerance <= 0) return {};
  const auto [touching, walls, tight] = reserves_of(evidence);
  const double least = std::min({touching, walls, tight});
  if (least > kHalf) return {};
  if (least == touching) {
    const bool inside = evidence.penetration_area > evidence.shared_area - evidence.contact_area;
    return inside ? "a part of one piece lies inside the other"
                  : fmt::format("of what lies on the other piece only {:.0f} % touches it",
                                100.0 * touching_share(evidence));
  }
  if (least == walls)
    return fmt::format("of the walls at the seam only {:.0f} % go on across it", 100.0 * evidence.wall_share);
  return fmt::format("the gap varies by {:.2g}, where sides of one break would keep their distance",
                     evidence.gap_spread);
}

bool drifts(const Evidence& evidence) {
  return evidence.drift > kDrift && evidence.drift_spread > evidence.explained;
}

Evidence with_fewer_patches(Evidence evidence) {
  if (evidence.drift <= kDrift) return evidence;
  evidence.information *= kDrifting;
  evidence.near_information *= kDrifting;
  return evidence;
}

Evidence told_by_scale(Evidence evidence, const Scales& scales) {
  const double part = std::min(1.0, scales.share / kSmallestShare);
  evidence.information *= part * part;
  evidence.near_information *= part * part;
  evidence.drift = scales.drift;
  evidence.drift_spread = scales.spread;
  return evidence;
}

double rank(const Evidence& evidence) {
  if (evidence.patch_area <= 0) return 0.0;
  const double patches = std::min(kMostPatches, evidence.contact_area / evidence.patch_area);
  return std::max(0.0, strength(evidence)) +
         kContact * patches * std::pow(touching_share(evidence), kOpenCosts);
}

}  // namespace rejoin::match
