#include <algorithm>
#include <cmath>
#include <limits>

#include "report/renderer.hpp"

namespace rejoin::report {
namespace {

/// Box of all vertices along the camera's axes.
struct Extent {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

glm::dmat3 camera_axes(const glm::dvec3& back, const glm::dvec3& up) {
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  return {right, glm::cross(back, right), back};
}

/// Calls act(point) with every vertex along the camera's axes.
template <class Act>
void for_each_vertex(const std::vector<Body>& bodies, const glm::dmat3& axes, const Act& act) {
  const glm::dmat3 turn = glm::transpose(axes);
  for (const Body& body : bodies) {
    const Rigid pose = Rigid{turn, glm::dvec3(0.0)} * body.pose;
    const glm::dvec3 offset = pose(body.mesh->origin);
    for (const glm::vec3& vertex : body.mesh->vertices) act(pose.rotation * glm::dvec3(vertex) + offset);
  }
}

}  // namespace

Camera fit_camera(const std::vector<Body>& bodies, const glm::dvec3& back, const glm::dvec3& up,
                  double aspect, double fov_deg, double margin) {
  const glm::dmat3 axes = camera_axes(back, up);
  Extent extent;
  for_each_vertex(bodies, axes, [&](const glm::dvec3& p) {
    extent.low = glm::min(extent.low, p);
    extent.high = glm::max(extent.high, p);
  });
  const glm::dvec3 middle = (extent.low + extent.high) / 2.0;
  const double free = 1 - 2 * margin;
  Camera camera;
  camera.target = axes * middle;
  camera.right = axes[0];
  camera.up = axes[1];
  const glm::dvec3 half = (extent.high - extent.low) / 2.0;
  camera.half_height = std::max({half.y, half.x / aspect, 1e-30}) / free;
  if (fov_deg <= 0) return camera;
  const double slope = std::tan(glm::radians(fov_deg / 2)) * free;
  for_each_vertex(bodies, axes, [&](const glm::dvec3& p) {
    const glm::dvec3 q = p - middle;
    camera.distance =
        std::max(camera.distance, std::max(std::abs(q.y), std::abs(q.x) / aspect) / slope + q.z);
  });
  camera.half_height = camera.distance * slope / free;
  return camera;
}

}  // namespace rejoin::report
