#include "report/joint_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "match/pose_space.hpp"
#include "report/canvas.hpp"
#include "report/depth_pictures.hpp"
#include "zbuffer/scorer.hpp"

namespace rejoin::report {
namespace {

/// The view turned about Z so that the joint's long axis lies level; B's frame turns the other way, as it
/// faces A.
zbuffer::ViewPair levelled(const zbuffer::ViewPair& view, const glm::dvec3& along) {
  const glm::dvec3 seen = glm::dmat3(view.rotation_a) * along;
  const double angle = -std::atan2(seen.y, seen.x);
  const glm::dmat3 turn = axis_rotation({0, 0, 1}, angle);
  zbuffer::ViewPair result = view;
  result.rotation_a = glm::mat3(turn * glm::dmat3(view.rotation_a));
  result.rotation_b = glm::mat3(glm::transpose(turn) * glm::dmat3(view.rotation_b));
  result.shift_a = glm::vec2(glm::dvec2(turn * glm::dvec3(view.shift_a, 0.0)));
  return result;
}

}  // namespace

JointMaps make_maps(const Joint& joint, int resolution) {
  zbuffer::ViewOptions options;
  options.resolution = resolution;
  options.view_side = 1.3 * std::max(mesh::diameter(joint.a), mesh::diameter(joint.b));
  options.centre_a = match::view_centre(joint.a);
  options.centre_b = match::view_centre(joint.b);
  const match::ViewCentres centres{joint.a.origin + glm::dvec3(options.centre_a),
                                   joint.b.origin + glm::dvec3(options.centre_b)};
  const match::FacingView facing = match::facing_view(joint.pose, joint.normal, centres);
  const auto scorer = zbuffer::make_scorer(zbuffer::Backend::Raster, joint.a, joint.b, options);
  const auto [a, b] = scorer->depth_maps(levelled(facing.view, joint.along));
  return {a, zbuffer::mirrored(b), zbuffer::slope_difference_map(a, b, options.view_side),
          zbuffer::slope_difference(a, b, options.view_side)};
}

zbuffer::DepthMap within_joint(const zbuffer::DepthMap& map, const zbuffer::DepthMap& difference) {
  zbuffer::DepthMap result = map;
  bool any = false;
  for (std::size_t k = 0; k < map.depth.size(); ++k) {
    any = any || !std::isnan(difference.depth[k]);
    if (std::isnan(difference.depth[k])) result.depth[k] = zbuffer::kBackground;
  }
  return any ? result : map;
}

Colour difference_colour(double share) {
  static const std::array<Colour, 7> kStops{Colour{6, 6, 30},     Colour{58, 16, 102}, Colour{122, 32, 108},
                                            Colour{186, 54, 85},  Colour{231, 94, 45}, Colour{249, 161, 26},
                                            Colour{250, 236, 160}};
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return mix(kStops[first], kStops[first + 1], at - static_cast<double>(first));
}

double difference_scale(const JointMaps& maps) {
  constexpr double kLeastScale = 0.02;  // below that it is rounding, not shape
  return round_up(std::max(kLeastScale, robust_range(maps.difference, 0.05).second));
}

}  // namespace rejoin::report
