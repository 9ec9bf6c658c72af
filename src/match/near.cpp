#include "match/near.hpp"

namespace rejoin::match {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kTilt_deg = 15.0;  // of two facets against each other at a true joint, at most

}  // namespace

Near::Near(const Fragment& a, const Fragment& b, const Rigid& in_files)
    : pose_(to_origins(a, b, in_files)),
      centre_b_(mesh::centroid(b.surface)),
      shift_(kShift * std::min(a.diameter, b.diameter)) {
  centre_ = pose_(centre_b_);
}

bool Near::holds(const Rigid& pose) const {
  return angle_between(pose, pose_) <= kTurn_deg * kDegree &&
         glm::distance(pose(centre_b_), centre_) <= shift_;
}

bool Near::may_become(const glm::dmat3& rotation) const {
  return angle_between({rotation, {}}, pose_) <= (kTurn_deg + kTilt_deg) * kDegree;
}

}  // namespace rejoin::match
