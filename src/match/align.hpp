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
};

/// What speaks for a joint and what against it, at one pose.  Areas in squared mesh units.
struct Evidence {
  double contact_area = 0;      ///< B's broken surface that faces A's within the tolerance
  double shared_area = 0;       ///< B's broken surface that lies over A's, touching or not
  double penetration_area = 0;  ///< surface of either that lies clearly inside the other
  double gap_median = 0;        ///< over the contact, mesh units, positive = apart
  double gap_spread = 0;        ///< median absolute deviation of the gaps, mesh units
  double penetration = 0;       ///< mean depth of what lies inside, mesh units; 0 if nothing does
  double explained =
      0;  ///< share of the relief of one side that the other explains, course of the facet taken off
  double relief = 0;     ///< rms of that relief's normals, radians
  double residual = 0;   ///< rms of what is left, radians
  double wall_step = 0;  ///< thin pieces: rms offset of the walls across the seam, mesh units
  double wall_bend =
      0;  ///< thin pieces: mean angle between the walls across the seam beyond their own curvature, radians
  double wall_share =
      0;              ///< thin pieces: share of the contact's seam along which walls were found on both sides
  double length = 0;  ///< longest extent of the contact, mesh units
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

  Evidence evidence(const Rigid& pose) const;

  /// Distance below which surfaces touch: a tenth of the wall of thin pieces, or what the scans can tell.
  double tolerance() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rejoin::match
