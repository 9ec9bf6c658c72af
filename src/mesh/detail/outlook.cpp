#include "mesh/detail/outlook.hpp"

#include <atomic>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "mesh/ray_scene.hpp"
#include "mesh/samples.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kPlaces = 500;
constexpr int kDirections = 16;
constexpr double kHidden = 0.15;  // of the rays from the front of a closed surface that is inside out
constexpr double kSeen = 0.5;     // more of those from its back leave

/// Directions spread evenly over the half sphere about a unit vector (Fibonacci lattice).
glm::vec3 direction(const glm::vec3& axis, int k) {
  const float height = (static_cast<float>(k) + 0.5F) / static_cast<float>(kDirections);
  const float radius = std::sqrt(1.0F - height * height);
  const float turn = std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F)) * static_cast<float>(k);
  const glm::vec3 across =
      glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.6F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  return height * axis + radius * (std::cos(turn) * across + std::sin(turn) * glm::cross(axis, across));
}

}  // namespace

Outlook outlook(const Mesh& mesh) {
  const Samples samples = sample_surface(mesh, kPlaces);
  const RayScene scene(mesh);
  const auto size = static_cast<float>(diameter(mesh));
  const float near = 1e-5F * size;
  std::atomic<std::size_t> front{0};
  std::atomic<std::size_t> back{0};
  parallel_for(samples.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (int k = 0; k < kDirections; ++k) {
        const glm::vec3 out = direction(samples.normals[i], k);
        if (!scene.first_hit(samples.points[i], out, near, 2 * size)) ++front;
        if (!scene.first_hit(samples.points[i], -out, near, 2 * size)) ++back;
      }
    }
  });
  const double rays = static_cast<double>(samples.size()) * kDirections;
  return {static_cast<double>(front) / rays, static_cast<double>(back) / rays};
}

bool is_inside_out(const Outlook& outlook) {
  return outlook.front < kHidden && outlook.back > outlook.front + kSeen;
}

}  // namespace rejoin::mesh::detail
