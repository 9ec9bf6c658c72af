#include "match/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/median.hpp"
#include "match/align.hpp"
#include "match/detail/joint_sides.hpp"
#include "match/detail/shape.hpp"
#include "match/detail/worth.hpp"

namespace rejoin::match {
namespace {

using detail::Finder;
using detail::heights_above_quadric;
using detail::kFacing;
using detail::kWallNear;
using detail::middle;
using detail::robust_deviation;
using detail::Worth;
using detail::worth_of;

constexpr int kBodySamples = 4000;    // of B that are asked whether they lie inside A
constexpr double kWallStep = 0.3;     // wall thicknesses by which walls that go on may be offset
constexpr double kWallsTell = 0.1;    // of the shared area, of walls at the seam that tell something
constexpr double kScanned = 0.5;      // wall thicknesses within which a scan has surface where it was scanned
constexpr double kWallBend = 0.25;    // walls bend by at most 75 degrees at a seam
constexpr double kWallTurn = -0.35;   // walls that bend by more, up to 110 degrees, tell nothing
constexpr int kQuadricRounds = 12;    // at most
constexpr double kBorderNear = 0.4;   // patches next to the contact that are left out: worn edges lie
constexpr double kBorderFar = 2.0;    // patches around the contact in which skin is compared
constexpr double kBorderAlike = 0.8;  // normals across a border differ by at most 37 degrees
constexpr double kBorderStep = 0.3;   // patches by which skin that goes on may be offset
constexpr std::array kScales{1.5,
                             3.0};  // patches: radii of the surroundings that tell small shape from large
constexpr double kNoLimit = -std::numeric_limits<double>::infinity();

/// Looks from B's samples to A.
class Look {
 public:
  Look(const detail::JointSides& sides, const Rigid& pose, int most_samples, bool quick)
      : sides_(sides),
        a_(sides.a()),
        b_(sides.b()),
        lengths_(sides.lengths()),
        move_(pose),
        most_samples_(most_samples),
        quick_(quick) {}

  /// The contact, to which complete() adds what speaks against the joint and what goes on across its border.
  struct Begun {
    Evidence evidence;
    std::vector<glm::vec3> touching;  ///< samples, A's axes
  };

  Begun begin(int facet_b) const {
    Begun begun;
    begun.evidence.tolerance = lengths_.tolerance;
    begun.evidence.explained = lengths_.explained;
    Contact contact = contact_of(facet_b);
    look_at_contact(contact, begun.evidence);
    begun.touching = std::move(contact.touching);
    return begun;
  }

  Evidence complete(const Begun& begun) const {
    Evidence e = begun.evidence;
    look_for_penetration(e);
    if (lengths_.thickness > 0) {
      look_at_walls(e);
    } else if (looks_across_border()) {
      look_across_border(begun.touching, e);
    }
    return e;
  }

  /// Joint::scales(), one way.
  Scales scales() const {
    const Contact contact = contact_of(-1);
    if (!contact.has_shape()) return {};
    const std::vector<double> heights =
        heights_above_quadric(contact.core, glm::normalize(contact.normal), kQuadricRounds);
    const std::array radii{kScales[0] * lengths_.patch, kScales[1] * lengths_.patch};
    const auto [relief, gaps] = detail::variances_by_scale(contact.core, {heights, contact.core_gaps}, radii);
    const double noise = lengths_.noise * lengths_.noise;
    const double spread = robust_deviation(gaps_above_quadric(contact));
    const double drift = gaps.front() > 0.0 ? spread / std::sqrt(gaps.front()) : 1.0;
    const double whole = std::log((relief.back() + noise) / (gaps.back() + noise));
    if (whole <= 0.0) return {.share = 1.0, .drift = drift, .spread = spread};
    double told = 0.0;
    double patches = 1.0;  // of all, what surroundings of this scale have of their own
    double inside_relief = 0.0;
    double inside_gaps = 0.0;
    for (std::size_t k = 0; k < relief.size(); ++k) {
      const double larger = k < kScales.size() ? 1.0 / (std::numbers::pi * kScales[k] * kScales[k]) : 0.0;
      // The mean over surroundings has that share of the smallest gaps' variance left.
      const double least = k == 0 ? noise : gaps.front() * patches;
      const double shape = std::max(0.0, relief[k] - inside_relief) + least;
      const double rest = std::max(0.0, gaps[k] - inside_gaps) + least;
      told += (patches - larger) * std::max(0.0, std::log(shape / rest));
      inside_relief = relief[k];
      inside_gaps = gaps[k];
      patches = larger;
    }
    return {.share = std::min(1.0, told / whole), .drift = drift, .spread = spread};
  }

  bool looks_across_border() const { return lengths_.thickness <= 0 && most_samples_ <= 0; }

 private:
  /// What of B lies over A.
  struct Contact {
    std::vector<double> gaps;
    std::vector<glm::dvec3> core;  ///< of these, what is not next to another facet, A's axes
    std::vector<double> core_gaps;
    std::vector<glm::vec3> touching;  ///< of all, A's axes
    std::size_t near_touching = 0;    ///< how many touch, and lie over A, within kNear times the distances
    std::size_t near_shared = 0;
    std::size_t unbacked = 0;  ///< of those that touch, how many have nothing behind them on either side
    double area = 0;           ///< of what lies over A
    glm::dvec3 normal{0.0};    ///< sum of A's

    bool has_shape() const { return core.size() >= 12 && glm::length(normal) > 0; }
  };

  /// \param facet  of B; -1: of all
  Contact contact_of(int facet) const {
    Contact c;
    const double over = kOver * lengths_.tolerance;
    const auto farthest = static_cast<float>(std::hypot(lengths_.spacing, kNear * over));
    const detail::Chosen chosen = detail::chosen_in(a_.broken_box, farthest, b_.broken.points,
                                                    b_.broken_of(facet), move_, most_samples_);
    const double each = chosen.each * b_.each_of(facet);
    for (const std::uint32_t i : chosen.list) {
      const glm::vec3 p = move_(b_.broken.points[i]);
      const auto hit = a_.broken_index->nearest_within(p, farthest);
      if (!hit) continue;
      const glm::vec3 n = a_.broken.normals[hit->first];
      const glm::vec3 offset = p - a_.broken.points[hit->first];
      const auto gap = static_cast<double>(glm::dot(offset, n));
      const double aside =
          std::sqrt(std::max(0.0, static_cast<double>(glm::dot(offset, offset)) - gap * gap));
      if (aside > lengths_.spacing || std::abs(gap) > kNear * over) continue;
      if (glm::dot(n, move_.direction(b_.broken.normals[i])) > kFacing) continue;
      ++c.near_shared;
      if (std::abs(gap) <= kNear * lengths_.tolerance) ++c.near_touching;
      if (std::abs(gap) > over) continue;
      c.gaps.push_back(gap);
      c.area += each * static_cast<double>(b_.broken.areas[i]);
      c.normal += glm::dvec3(n);
      if (!b_.broken.edge[i] && !a_.broken.edge[hit->first]) {
        c.core.emplace_back(p);
        c.core_gaps.push_back(gap);
      }
      if (std::abs(gap) > lengths_.tolerance) continue;
      c.touching.push_back(p);
      c.unbacked += b_.broken.backed[i] || a_.broken.backed[hit->first] ? 0 : 1;
    }
    return c;
  }

  void look_at_contact(const Contact& c, Evidence& e) const {
    // Single samples' areas vary too much to tell shares of the contact by them.
    const double each = c.area / static_cast<double>(std::max<std::size_t>(1, c.gaps.size()));
    e.contact_area = static_cast<double>(c.touching.size()) * each;
    e.near_contact_area = static_cast<double>(c.near_touching) * each;
    e.near_shared_area = static_cast<double>(c.near_shared) * each;
    e.shared_area = c.area;
    e.unbacked_area = static_cast<double>(c.unbacked) * each;
    e.patch_area = lengths_.patch * lengths_.patch;
    e.gap_median = median_gap(c.gaps);
    if (glm::length(c.normal) > 0) e.normal = glm::normalize(c.normal);
    e.core_samples = static_cast<int>(c.core.size());
    if (!c.has_shape()) return;
    const int rounds =
        most_samples_ > 0 ? 1 : kQuadricRounds;  // few samples have no bulk to tell from the rest
    std::vector<double> gaps = c.core_gaps;
    e.gap_middle = median(gaps);
    e.gap_spread = robust_deviation(std::move(gaps));
    e.relief = robust_deviation(heights_above_quadric(c.core, glm::normalize(c.normal), rounds));
    e.centre = middle(c.core);
    e.information = 0.5 * static_cast<double>(c.core.size()) * each / e.patch_area *
                    std::log((e.relief * e.relief + lengths_.noise * lengths_.noise) /
                             (e.gap_spread * e.gap_spread + lengths_.noise * lengths_.noise));
    e.near_information = e.information;
  }

  /// Of the core's gaps, over the plane of the joint.
  static std::vector<double> gaps_above_quadric(const Contact& contact) {
    const glm::dvec3 normal = glm::normalize(contact.normal);
    std::vector<glm::dvec3> raised = contact.core;
    for (std::size_t i = 0; i < raised.size(); ++i)
      raised[i] += (contact.core_gaps[i] - glm::dot(raised[i], normal)) * normal;
    return heights_above_quadric(raised, normal, kQuadricRounds);
  }

  void look_for_penetration(Evidence& e) const {
    const Finder finder = sides_.body_finder(quick_);
    const int most = most_samples_ > 0 ? std::min(most_samples_, kBodySamples) : kBodySamples;
    const detail::Chosen chosen =
        detail::chosen_in(a_.body_box, 0.0, b_.body.points, b_.all_body, move_, most);
    const double each = chosen.each * static_cast<double>(b_.step);
    double inside = 0.0;
    double depth = 0.0;
    for (const std::uint32_t i : chosen.list) {
      const glm::vec3 p = move_(b_.body.points[i]);
      const auto hit = finder.within(p, lengths_.deepest);
      if (!hit) continue;
      const glm::vec3 offset = p - a_.body.points[hit->first];
      const auto gap = static_cast<double>(glm::dot(offset, a_.body.normals[hit->first]));
      if (gap > -3.0 * lengths_.tolerance || -gap < 0.7 * static_cast<double>(hit->second)) continue;
      const double area = each * static_cast<double>(b_.body.areas[i]);
      inside += area;
      depth -= gap * area;
    }
    e.penetration_area = inside;
    e.penetration = inside > 0 ? depth / inside : 0.0;
  }

  void look_at_walls(Evidence& e) const {
    const double near = kWallNear * lengths_.thickness;
    const Finder near_broken = sides_.broken_finder(quick_);
    const Finder finder = sides_.wall_finder(quick_);
    const Finder anything = sides_.body_finder(quick_);
    const double step = kWallStep * lengths_.thickness;
    double found = 0.0;  // areas
    double all = 0.0;
    const detail::Chosen chosen =
        detail::chosen_in(a_.broken_box, near, b_.walls.points, b_.all_walls, move_, most_samples_);
    for (const std::uint32_t i : chosen.list) {
      const glm::vec3 p = move_(b_.walls.points[i]);
      const auto hit = near_broken.within(p, near);
      if (!hit) continue;
      const glm::vec3 seam = a_.broken.points[hit->first];
      const glm::dvec3 normal(move_.direction(b_.walls.normals[i]));
      bool goes = goes_on(p, normal, seam, near, finder, {a_.walls, kWallBend, step});
      if (!goes && a_.open) {
        if (!anything.within(2.0F * seam - p, kScanned * lengths_.thickness)) continue;
        goes = goes_on(p, normal, seam, near, anything, {a_.body, kWallBend, step});
      }
      if (!goes && turns_away(p, normal, seam, near, finder)) continue;
      const double area = chosen.each * static_cast<double>(b_.walls.areas[i]);
      all += area;
      if (goes) found += area;
    }
    if (all > kWallsTell * e.shared_area) e.wall_share = found / all;
  }

  /// What of B lies around the contact, and whether A goes on there: at a true joint the skin of the object does, on both sides
  /// of the crack.  Where a third piece has its place, or a wrong pose ends, one surface rises from the other.
  void look_across_border(const std::vector<glm::vec3>& touching, Evidence& e) const {
    if (touching.empty()) return;
    const double far = kBorderFar * lengths_.patch;
    const mesh::PointIndex contact(touching);
    const Finder finder = sides_.body_finder(false);
    double found = 0.0;
    for (const std::uint32_t i : b_.all_body) {
      const glm::vec3 p = move_(b_.body.points[i]);
      const auto border = contact.nearest_within(p, static_cast<float>(far));
      if (!border || border->second < kBorderNear * lengths_.patch) continue;
      const glm::dvec3 normal(move_.direction(b_.body.normals[i]));
      if (goes_on(p, normal, touching[border->first], far, finder,
                  {a_.body, kBorderAlike, kBorderStep * lengths_.patch}))
        found += static_cast<double>(b_.body.areas[i]);
    }
    e.continuation = found * static_cast<double>(b_.step) / e.patch_area;
  }

  /// What surfaces of one skin have in common.
  struct Skin {
    const detail::Cloud& of_a;
    double bend;  ///< cosine of the angle between normals, at least
    double step;  ///< mesh units, at most
  };

  /// Whether a point of B belongs to a skin that goes on in A.  Where it bends along the seam, what is as far behind the seam as
  /// the point is before it shows no step.
  bool goes_on(const glm::vec3& p, const glm::dvec3& normal, const glm::vec3& seam, double near,
               const Finder& finder, const Skin& skin) const {
    const auto alike = [&](const std::optional<std::pair<std::uint32_t, float>>& hit) {
      if (!hit) return false;
      const glm::dvec3 other(skin.of_a.normals[hit->first]);
      if (glm::dot(other, normal) < skin.bend) return false;
      const glm::dvec3 between = glm::normalize(other + normal);
      return std::abs(glm::dot(glm::dvec3(p - skin.of_a.points[hit->first]), between)) < skin.step;
    };
    return alike(finder.within(p, 2.0 * near)) || alike(finder.within(2.0F * seam - p, near));
  }

  /// Whether A's wall, where B's would go on straight, looks away from it by about a right angle, as along the edge of a foot: no place
  /// of it can be compared.
  bool turns_away(const glm::vec3& p, const glm::dvec3& normal, const glm::vec3& seam, double near,
                  const Finder& finder) const {
    const auto beyond = finder.within(2.0F * seam - p, near);
    if (!beyond) return false;
    const double bend = glm::dot(glm::dvec3(a_.walls.normals[beyond->first]), normal);
    return bend < kWallBend && bend > kWallTurn;
  }

  const detail::JointSides& sides_;
  const detail::Side& a_;
  const detail::Side& b_;
  const detail::JointLengths& lengths_;
  detail::Move move_;
  int most_samples_;
  bool quick_;
};

/// At most what continuation adds once a look is complete.
double most_of_continuation(const Look& look, const Evidence& begun) {
  return look.looks_across_border() ? detail::most_of_skin(begun) : 0.0;
}

/// Whether a bound is not above the limit, with more room than rounding takes.
bool stays_below(double bound, double limit) {
  return bound * (1.0 + 1e-9) <= limit;
}

}  // namespace

double median_gap(std::vector<double> gaps) {
  for (double& gap : gaps) gap = std::abs(gap);
  return gaps.empty() ? std::numeric_limits<double>::infinity() : median(gaps);
}

std::optional<Evidence> Joint::evidence_above(double limit, const Rigid& pose,
                                              const LookOptions& options) const {
  const Look look(*sides_, pose, options.most_samples, options.quick);
  const Look::Begun begun = look.begin(options.facet_b);
  // What is inside the other body and walls that do not go on only take from the worth.
  const double shape = std::max(0.0, worth_of(begun.evidence).strength());
  if (stays_below(shape + most_of_continuation(look, begun.evidence), limit)) return std::nullopt;
  return look.complete(begun);
}

Evidence Joint::evidence(const Rigid& pose, int most_samples, int facet_b, bool quick) const {
  return *evidence_above(kNoLimit, pose, {most_samples, facet_b, quick});
}

Scales Joint::scales(const Rigid& pose) const {
  const Scales there = Look(*sides_, pose, 0, false).scales();
  const Scales back = Look(*exchanged_, inverse(pose), 0, false).scales();
  return {.share = std::sqrt(there.share * back.share),
          .drift = std::sqrt(there.drift * back.drift),
          .spread = std::sqrt(there.spread * back.spread)};
}

std::optional<Evidence> Joint::agreed_evidence_above(double limit, const Rigid& pose) const {
  const Look look(*sides_, pose, 0, false);
  const Look::Begun begun = look.begin(-1);
  const double continuation = most_of_continuation(look, begun.evidence);
  const Worth shape = worth_of(begun.evidence);
  if (shape.none() && stays_below(continuation, limit)) return std::nullopt;
  const Look look_from_a(*exchanged_, inverse(pose), 0, false);
  const Look::Begun begun_from_a = look_from_a.begin(-1);
  const Worth most = agreed(shape, worth_of(begun_from_a.evidence));
  if (stays_below(most.strength() + continuation, limit)) return std::nullopt;
  Evidence evidence = look.complete(begun);
  const Worth there = worth_of(evidence);
  if (there.none() && evidence.continuation <= 0.0) return evidence;  // whatever A's samples say
  const Evidence from_a = look_from_a.complete(begun_from_a);
  const Worth both = agreed(there, worth_of(from_a));
  if (there.close > 0.0) evidence.information *= both.close / there.close;
  if (there.near > 0.0) evidence.near_information *= both.near / there.near;
  evidence.continuation = std::min(evidence.continuation, from_a.continuation);
  return evidence;
}

Evidence Joint::agreed_evidence(const Rigid& pose) const {
  return *agreed_evidence_above(kNoLimit, pose);
}

}  // namespace rejoin::match
