/// What a joint looks like at one pose, and what that is worth.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

namespace rejoin::match {

/// Tolerances within which one surface lies over the other, touching or not.
inline constexpr double kOver = 4.0;

/// Tolerances within which surfaces may touch if scans are less true than their points are dense, or breaks worn.
inline constexpr double kNear = 2.0;

/// The figure "gap median" of a joint, wherever it is told: the median of |gap|, so that gaps on both sides do not cancel.
/// \param gaps  signed, mesh units, of samples of B's broken surface that lie over A's
/// \return infinite without samples
double median_gap(std::vector<double> gaps);

/// Why a pose is held back: it is as likely as not at most.
enum class Doubt {
  None,
  Walls,  ///< may_be_walls()
  Loose,  ///< lies_loosely()
  Faint,  ///< hardly_agrees()
  Drift,  ///< drifts()
  Slide,  ///< one piece along the other: hold_sliding()
};

/// What speaks for a joint and what against it, at one pose.  Areas in squared mesh units.
struct Evidence {
  double contact_area = 0;  ///< B's broken surface that faces A's within the tolerance
  /// B's broken surface that lies over A's, touching or not (within kOver tolerances).
  double shared_area = 0;
  double near_contact_area = 0;  ///< contact_area within kNear times its distance
  double near_shared_area = 0;   ///< shared_area within kNear times its distance
  double unbacked_area = 0;      ///< of the contact, what has nothing behind it on either side
  double patch_area = 0;         ///< of a patch of surface whose relief is independent of the next one's
  int core_samples = 0;          ///< of the shared surface, those that are not next to another facet
  double gap_median = std::numeric_limits<double>::infinity();  ///< median_gap() over the shared area
  double gap_middle =
      0;  ///< median of the core's gaps, mesh units; below 0 where the surfaces are in each other
  double gap_spread = 0;  ///< robust deviation (1.48 MAD) of these, mesh units
  double relief = 0;      ///< robust deviation of the shared surface from a quadric: what there is to explain
  double information =
      0;  ///< how much shape agrees: n/2 log((relief^2 + noise^2) / (gap_spread^2 + noise^2)), nats,
          ///< n = independent patches of the shared area.  Flat on flat gives none.
  double near_information = 0;  ///< the part of it that both ways agree on within kNear times the distances
  double penetration = 0;  ///< mean depth of what lies inside the other body, mesh units; 0 if nothing does
  double penetration_area = 0;  ///< surface of B that lies clearly inside A's body
  /// Thin pieces: share of the walls at the seam that go on on the other side; 1 for solid ones or without walls.
  double wall_share = 1;
  /// Solid pieces, all samples looked at: skin around the contact that goes on across its border, in patches.  0 for thin ones.
  double continuation = 0;
  double drift = 1;           ///< Scales::drift and Scales::spread, once told_by_scale() was asked
  double drift_spread = 0;    ///< mesh units
  Doubt doubt = Doubt::None;  ///< once weigh()ed
  double tolerance = 0;       ///< distance below which the surfaces touch, mesh units
  /// Gap spread that the scans' errors explain at most, or that tells nothing, mesh units; infinite where these are not known.
  double explained = std::numeric_limits<double>::infinity();
  glm::dvec3 normal{0.0};  ///< mean outward normal of A's shared surface, unit; 0 without any
  glm::dvec3 centre{0.0};  ///< of the shared surface, relative to A's origin
};

/// What the evidence is worth: information, less what the joint leaves open or overlaps, and for solid pieces what goes on across
/// its border.  Comparable across pairs.
/// \source docs/scoring.md
double strength(const Evidence& evidence);

/// What takes most from the strength that the shape would have, for users; empty if nothing takes half of it.
std::string objection(const Evidence& evidence);

/// Of what lies over the other surface or inside the other body, the share that touches, 0..1.
double touching_share(const Evidence& evidence);

/// What of a joint is seen at which scale.
struct Scales {
  /// Of Evidence::information, 0 .. 1, what is left if deviations within small surroundings, between these within larger ones, and between
  /// larger ones are each weighed with the gaps of the same scale, and with the number of such surroundings.  As it is, every patch
  /// counts as one that is independent of the others; of smooth surfaces the shape is the same over many patches.
  double share = 1;
  /// Deviation of the gaps from a quadric over the whole break, which takes off what scans bend and scale, over that from their mean in
  /// small surroundings: about 1 where sides of one break lie on each other, more where surfaces that are alike bend away from each other.
  double drift = 1;
  double spread = 0;  ///< that deviation from a quadric, mesh units
};

/// The evidence with its drift, and less information where too little is left of it scale by scale, as where smooth surfaces fit each
/// other loosely.
/// \source docs/scoring.md
Evidence told_by_scale(Evidence evidence, const Scales& scales);

/// Whether the gaps drift by more than the scans' errors explain, as where parts of one form broke alike, and where breaks are worn.
/// \source docs/scoring.md
bool drifts(const Evidence& evidence);

/// The evidence of solid pieces with less information where gaps drift, whatever explains it: they are alike over several patches then.
/// \pre told_by_scale()
Evidence with_fewer_patches(Evidence evidence);

/// What poses of one pair are ordered by: the strength, and a little for every patch that touches.  The strength of weak poses may
/// be chance, and of these the right ones have more contact.  Says nothing across pairs.
/// \source docs/scoring.md
double rank(const Evidence& evidence);

}  // namespace rejoin::match
