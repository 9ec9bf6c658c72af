/// Depth maps along a joint.
#pragma once

#include "report/image.hpp"
#include "report/joint.hpp"
#include "zbuffer/depth_map.hpp"
#include "zbuffer/error.hpp"

namespace rejoin::report {

/// Both maps of the joint, in A's frame, and where their slopes differ.
struct JointMaps {
  zbuffer::DepthMap a;
  zbuffer::DepthMap b;  ///< mirrored into A's frame
  zbuffer::DepthMap difference;
  zbuffer::PairScore score;
};

/// \param resolution  pixels across the view of the whole fragments; the joint's long axis lies level
JointMaps make_maps(const Joint& joint, int resolution);

/// Depths where both maps are covered, so that the colours show the relief of the joint; the whole map's
/// otherwise.
zbuffer::DepthMap within_joint(const zbuffer::DepthMap& map, const zbuffer::DepthMap& difference);

/// Inferno-like: dark where the slopes agree, bright where they do not.  share 0 .. 1
Colour difference_colour(double share);

/// The slope difference of the brightest colour, a round number.
double difference_scale(const JointMaps& maps);

}  // namespace rejoin::report
