#include "mesh/detail/outlook.hpp"

#include <atomic>
#include <cmath>
#include <vector>

#include "core/parallel.hpp"
#include "mesh/detail/directions.hpp"
#include "mesh/samples.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kPlaces = 500;
constexpr std::size_t kDirections = 16;
constexpr double kHidden = 0.15;  // of the rays from the front of a closed surface that is inside out
constexpr double kSeen = 0.5;     // more of those from its back leave

}  // namespace

Outlook outlook(const Mesh& mesh) {
  return outlook(mesh, RayScene(mesh), diameter(mesh));
}

Outlook outlook(const Mesh& part, const RayScene& whole, double size) {
  const Samples samples = sample_surface(part, kPlaces);
  const std::vector<glm::vec3> directions = half_sphere_directions(kDirections);
  const auto near = static_cast<float>(1e-5 * size);
  const auto far = static_cast<float>(2.0 * size);
  std::atomic<std::size_t> front{0};
  std::atomic<std::size_t> back{0};
  parallel_for(samples.size(), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const glm::mat3 frame = frame_about(samples.normals[i]);
      for (const glm::vec3& direction : directions) {
        const glm::vec3 out = frame * direction;
        if (!whole.first_hit(samples.points[i], out, near, far)) ++front;
        if (!whole.first_hit(samples.points[i], -out, near, far)) ++back;
      }
    }
  });
  const double rays = static_cast<double>(samples.size() * kDirections);
  return {static_cast<double>(front) / rays, static_cast<double>(back) / rays};
}

bool is_inside_out(const Outlook& outlook) {
  return outlook.front < kHidden && outlook.back > outlook.front + kSeen;
}

}  // namespace rejoin::mesh::detail
