/// How far a pose is off, as the project measures it.
#pragma once

#include <optional>
#include <vector>

#include "match/match.hpp"

namespace rejoin::bench {

struct Deviation {
  double angle_rad = 0;
  double displacement = 0;  ///< mean over B's vertices, fraction of the diameter of both fragments joined
};

/// The truth about one pair.
class PairTruth {
 public:
  /// \param pose  B's file coordinates -> A's
  PairTruth(const match::Fragment& a, const match::Fragment& b, const Rigid& pose);

  const Rigid& pose() const { return pose_; }
  Deviation deviation(const Rigid& first, const Rigid& second) const;
  bool right(const Rigid& pose) const;    ///< within 5 degrees and 2 % of the truth: found
  bool precise(const Rigid& pose) const;  ///< within 1 degree and 0.5 %

  /// Mean outward normal of A where B lies opposite to it, A's file axes; nullopt if nothing does.
  const std::optional<glm::dvec3>& direction() const { return direction_; }

 private:
  Rigid pose_;
  std::vector<glm::dvec3> points_;  // of B, file coordinates
  double diameter_ = 0;
  std::optional<glm::dvec3> direction_;
};

}  // namespace rejoin::bench
