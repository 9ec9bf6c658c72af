/// From a rough pose to the scans' accuracy, and what the joint then looks like.
#pragma once

#include <memory>

#include "core/rigid.hpp"
#include "match/match.hpp"

namespace rejoin::match {

struct AlignOptions {
  double reach_start = 0;  ///< facing samples farther apart than this do not count at first, mesh units
  double reach_end = 0;    ///< nor than this in the end
  int iterations = 12;
  int most_samples = 400;  ///< of B's samples; 0: all
  bool core_only = false;  ///< leave out what is next to another facet: worn edges lie
  int facet_b = -1;        ///< only samples of this facet of B; -1: of all its broken surface
  bool quick = false;      ///< nearest points are looked up in tables: they are nearly the nearest
  int half = -1;           ///< 0 or 1: every other of B's broken samples: the two share none; -1: all
};

/// What speaks for a joint and what against it, at one pose.  Areas in squared mesh units.
struct Evidence {
  double contact_area = 0;  ///< B's broken surface that faces A's within the tolerance
  /// B's broken surface that lies over A's, touching or not (within four tolerances).
  double shared_area = 0;
  double patches = 0;     ///< the shared area in patches whose relief is independent
  int core_samples = 0;   ///< of the shared surface, those that are not next to another facet
  double gap_median = 0;  ///< over the shared area, mesh units, positive = apart
  double gap_spread = 0;  ///< robust deviation (1.48 MAD) of the gaps, mesh units
  double relief = 0;      ///< robust deviation of the shared surface from a quadric: what there is to explain
  double information =
      0;  ///< how much shape agrees: n/2 log((relief^2 + noise^2) / (gap_spread^2 + noise^2)), nats,
          ///< n = independent patches of the shared area.  Flat on flat gives none.
  double penetration = 0;  ///< mean depth of what lies inside the other body, mesh units; 0 if nothing does
  double penetration_area = 0;  ///< surface of B that lies clearly inside A's body
  /// Thin pieces: share of the walls at the seam that go on on the other side; 1 for solid ones or without walls.
  double wall_share = 1;
  double tolerance = 0;    ///< distance below which the surfaces touch, mesh units
  glm::dvec3 normal{0.0};  ///< mean outward normal of A's shared surface, unit; 0 without any
  glm::dvec3 centre{0.0};  ///< of the shared surface, relative to A's origin
  glm::dvec3 along{0.0};   ///< its longest direction, unit; 0 without any
};

/// Two prepared fragments, indexed for alignment.  Poses are B -> A, both relative to their mesh's origin.
/// Const members may be called from several threads.
class Joint {
 public:
  /// The fragments must outlive the object.
  Joint(const Fragment& a, const Fragment& b);
  ~Joint();

  /// Robust point-to-plane alignment of the facing broken surfaces; for thin pieces the walls across the seam
  /// are lined up too. Gaps are tolerated (worn surfaces recede): outliers weigh nothing (Tukey).
  Rigid align(const Rigid& start, const AlignOptions& options) const;

  /// \param most_samples  of B's samples are looked at; 0: all
  /// \param facet_b       only samples of this facet of B touch; -1: all its broken surface
  /// \param quick         as in AlignOptions, for what speaks against the joint; the contact is measured exactly
  Evidence evidence(const Rigid& pose, int most_samples, int facet_b = -1, bool quick = false) const;

  /// The evidence of all samples, with the information that both surfaces agree on: strength() of it is the geometric mean of
  /// those that B's samples over A and A's over B have.  Shape that one of the two has alone, as a rough break on a plane, says
  /// nothing.
  Evidence agreed_evidence(const Rigid& pose) const;

  /// Distance below which surfaces touch: a twentieth of the wall of thin pieces, or what the scans can tell.
  double tolerance() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::unique_ptr<Impl> back_;  ///< the same two, A and B exchanged
};

}  // namespace rejoin::match
