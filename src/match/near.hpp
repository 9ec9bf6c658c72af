/// Poses near one that the user has laid by hand.
#pragma once

#include "match/match.hpp"

namespace rejoin::match {

/// What counts as near a rough pose.
class Near {
 public:
  /// \param in_files  the rough pose, B's file coordinates -> A's
  Near(const Fragment& a, const Fragment& b, const Rigid& in_files);

  /// The rough pose, relative to the meshes' origins.
  const Rigid& pose() const { return pose_; }

  /// Whether a pose is turned by at most kTurn_deg against the rough one, and puts B's centroid off by at most kShift of the
  /// smaller fragment's diameter.
  /// \param pose  relative to the meshes' origins
  bool holds(const Rigid& pose) const;

  /// Whether a rotation is near enough for what an alignment may still turn.
  bool may_become(const glm::dmat3& rotation) const;

  static constexpr double kTurn_deg = 25.0;
  static constexpr double kShift = 0.25;

 private:
  Rigid pose_;
  glm::dvec3 centre_;  ///< of B, where the rough pose puts it
  glm::dvec3 centre_b_;
  double shift_ = 0;
};

/// Whether any pose near a rough one may bring the surfaces together: if not, their boxes lie farther apart than B can move.
/// \param in_files  the rough pose, B's file coordinates -> A's
bool may_touch(const Fragment& a, const Fragment& b, const Rigid& in_files);

}  // namespace rejoin::match
