#include "match/pose_space.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"

namespace rejoin::match {
namespace {

const glm::dvec3 kX(1, 0, 0);
const glm::dvec3 kY(0, 1, 0);
const glm::dvec3 kZ(0, 0, 1);

// Half a turn about Y: B's view axes -> A's view axes.
const glm::dmat3 kFaceToFace(-1, 0, 0, 0, 1, 0, 0, 0, -1);

}  // namespace

zbuffer::ViewPair view_of(std::span<const double> pose, const Alignment& alignment, RotationOrder order) {
  const glm::dmat3 about_z = axis_rotation(kZ, pose[kRho1]);
  const glm::dmat3 tilt_a = axis_rotation(kX, pose[kTheta1]) * axis_rotation(kY, pose[kPhi1]);
  const glm::dmat3 tilt_b = axis_rotation(kX, pose[kTheta2]) * axis_rotation(kY, pose[kPhi2]);
  const glm::dmat3 turn_a = order == RotationOrder::ZLast ? about_z * tilt_a : tilt_a * about_z;
  zbuffer::ViewPair view;
  view.rotation_a = glm::mat3(turn_a * alignment.rotation_a);
  view.rotation_b = glm::mat3(tilt_b * alignment.rotation_b);
  view.shift_a = glm::vec2(alignment.shift_a + glm::dvec2(pose[kX1], pose[kY1]));
  return view;
}

glm::dvec3 view_centre(const mesh::Mesh& mesh) {
  // Badoiu and Clarkson 2003: step k goes 1 / (k + 1) of the way to the farthest point; after k steps the
  // radius is within a factor 1 + 1 / sqrt(k) of the smallest, in practice far less.
  constexpr int kSteps = 300;
  if (mesh.vertices.empty()) return glm::dvec3(0.0);
  glm::dvec3 centre(mesh.vertices.front());
  for (int k = 1; k <= kSteps; ++k) {
    glm::dvec3 farthest = centre;
    double largest = 0;
    for (const glm::vec3& v : mesh.vertices) {
      const glm::dvec3 offset = glm::dvec3(v) - centre;
      const double squared = glm::dot(offset, offset);
      if (squared > largest) {
        largest = squared;
        farthest = v;
      }
    }
    centre += (farthest - centre) / (k + 1.0);
  }
  return centre;
}

double contact_offset(const zbuffer::DepthMap& a, const zbuffer::DepthMap& b, double view_side,
                      const ContactOptions& options) {
  if (a.width != b.width || a.height != b.height) throw InputError("depth maps", "their shapes differ");
  std::vector<double> touching;
  for (int j = 0; j < a.height; ++j) {
    for (int i = 0; i < a.width; ++i) {
      const double both = static_cast<double>(a.at(i, j)) + b.at(a.width - 1 - i, j);
      if (!std::isnan(both)) touching.push_back(view_side - both);
    }
  }
  if (touching.empty()) return view_side;
  const double share = std::clamp(options.percentile, 0.0, 1.0);
  const auto place =
      static_cast<std::ptrdiff_t>(std::floor(share * static_cast<double>(touching.size() - 1)));
  std::nth_element(touching.begin(), touching.begin() + place, touching.end());
  return touching[static_cast<std::size_t>(place)];
}

Rigid pose_of(const zbuffer::ViewPair& view, double offset, const ViewCentres& centres) {
  // The view holds floats: as they are, their product would not be orthonormal to double precision.
  const auto orthonormal = [](const glm::mat3& m) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(m[0]));
    const glm::dvec3 y = glm::normalize(glm::dvec3(m[1]) - glm::dot(glm::dvec3(m[1]), x) * x);
    return glm::dmat3(x, y, glm::cross(x, y));
  };
  const glm::dmat3 back = glm::transpose(orthonormal(view.rotation_a));
  const glm::dmat3 turn = back * kFaceToFace * orthonormal(view.rotation_b);
  const glm::dvec3 place = back * (glm::dvec3(0, 0, offset) - glm::dvec3(view.shift_a, 0)) + centres.a;
  return {turn, place - turn * centres.b};
}

FacingView facing_view(const Rigid& pose, const glm::dvec3& direction, const ViewCentres& centres) {
  const glm::dmat3 turn_a = rotation_between(direction, kZ);
  const glm::dvec3 gap = turn_a * (pose(centres.b) - centres.a);
  FacingView facing;
  facing.view.rotation_a = glm::mat3(turn_a);
  facing.view.rotation_b = glm::mat3(glm::transpose(kFaceToFace) * turn_a * pose.rotation);
  facing.view.shift_a = -glm::vec2(gap);
  facing.offset = gap.z;
  return facing;
}

}  // namespace rejoin::match
