#include "report/joint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/surface.hpp"
#include "report/canvas.hpp"
#include "report/colour_scale.hpp"

namespace rejoin::report {
namespace {

constexpr double kFarthest = 0.03;  ///< of the diameter: what is farther apart was never one surface

mesh::Mesh for_pictures(const mesh::Mesh& mesh) {
  return mesh.faces.size() > kPictureFaces ? mesh::simplify(mesh, kPictureFaces) : mesh;
}

/// Keeps the gaps of vertices in contact within reach.
std::vector<float> contact_gaps(const match::Gaps& gaps, double reach) {
  std::vector<float> result(gaps.gap);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const bool touches = match::in_contact(gaps, i) && std::abs(gaps.gap[i]) <= reach;
    if (!touches) result[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return result;
}

glm::dvec3 unit_or(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

/// Angle of the main direction of a symmetric 2 x 2 matrix.
double main_angle(double xx, double xy, double yy) {
  return 0.5 * std::atan2(2 * xy, xx - yy);
}

/// Lays `along` along the contact and measures it.
void find_axes(Joint& joint) {
  const glm::dmat3 frame = frame_of(joint.normal);
  std::vector<glm::dvec2> points;
  for (std::size_t i = 0; i < joint.a.vertices.size(); ++i) {
    if (std::isnan(joint.gap_a[i])) continue;
    const glm::dvec3 p = joint.a.origin + glm::dvec3(joint.a.vertices[i]) - joint.centre;
    points.emplace_back(glm::dot(p, frame[0]), glm::dot(p, frame[1]));
  }
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
  glm::dvec3 spread(0.0);  // xx, xy, yy
  for (const glm::dvec2& p : points) {
    const glm::dvec2 d = p - mean;
    spread += glm::dvec3(d.x * d.x, d.x * d.y, d.y * d.y);
  }
  const double angle = main_angle(spread.x, spread.y, spread.z);
  joint.along = std::cos(angle) * frame[0] + std::sin(angle) * frame[1];
  joint.across = glm::cross(joint.normal, joint.along);
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const glm::dvec2& p : points) {
    const glm::dvec2 q(p.x * std::cos(angle) + p.y * std::sin(angle),
                       p.y * std::cos(angle) - p.x * std::sin(angle));
    low = glm::min(low, q);
    high = glm::max(high, q);
  }
  if (points.empty()) return;
  joint.length = high.x - low.x;
  joint.width = high.y - low.y;
  const glm::dvec2 middle = (low + high) / 2.0;
  joint.centre += middle.x * joint.along + middle.y * joint.across;
}

}  // namespace

Joint make_joint(const mesh::Mesh& a, const mesh::Mesh& b, const Rigid& pose, const glm::dvec3& direction,
                 double resolution) {
  Joint joint{for_pictures(a), for_pictures(b), pose, {}, {}, 0, 0, {}, {}, {}, {}, {}, 0, 0};
  const match::GapField field_a(joint.a);
  const match::GapField field_b(joint.b);
  const double farthest = round_up(kFarthest * std::max(mesh::diameter(joint.a), mesh::diameter(joint.b)));
  match::Gaps gaps_a = match::gaps(joint.a, field_b, pose, farthest);
  const double typical = match::contact_of(joint.a, gaps_a).gap_p90;
  joint.reach = round_up(std::clamp(2 * typical, std::min(2 * resolution, farthest), farthest));
  joint.gap_a = contact_gaps(gaps_a, joint.reach);
  joint.gap_b = contact_gaps(match::gaps(joint.b, field_a, inverse(pose), joint.reach), joint.reach);
  for (std::size_t i = 0; i < joint.gap_a.size(); ++i) {
    if (std::isnan(joint.gap_a[i])) gaps_a.facing[i] = std::numeric_limits<float>::quiet_NaN();
  }
  joint.contact = match::contact_of(joint.a, gaps_a);
  const double finest = std::max(1e-3 * joint.reach, 0.05 * resolution);
  joint.scale = std::min(joint.reach, round_up(std::max(kMedianGaps * joint.contact.gap_median, finest)));
  const glm::dvec3 centre_a = joint.a.origin + mesh::centroid(joint.a);
  const glm::dvec3 centre_b = pose(joint.b.origin + mesh::centroid(joint.b));
  const glm::dvec3 fallback = unit_or(direction, unit_or(centre_b - centre_a, {0, 0, 1}));
  const bool meets = joint.contact.area > 0;
  joint.normal = meets ? unit_or(joint.contact.normal, fallback) : fallback;
  joint.centre = meets ? joint.contact.centre : (centre_a + centre_b) / 2.0;
  find_axes(joint);
  return joint;
}

}  // namespace rejoin::report
