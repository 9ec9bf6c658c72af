#include "mesh/detail/inside.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/median.hpp"
#include "mesh/detail/directions.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr int kAround = 8;
constexpr double kLean = 25.0 / 180.0 * std::numbers::pi;
constexpr std::size_t kWide = 32;
constexpr double kStart = 0.05;  // of the edges

std::vector<glm::vec3> narrow_directions() {
  std::vector<glm::vec3> directions{{0, 0, 1}};
  for (int k = 0; k < kAround; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / kAround;
    directions.emplace_back(std::sin(kLean) * std::cos(turn), std::sin(kLean) * std::sin(turn),
                            std::cos(kLean));
  }
  return directions;
}

}  // namespace

Inside::Inside(const Mesh& mesh)
    : scene_(mesh),
      face_normals_(face_normals(mesh)),
      narrow_(narrow_directions()),
      wide_(half_sphere_directions(kWide)),
      start_(static_cast<float>(kStart * resolution(mesh))) {}

std::optional<RayScene::Hit> Inside::exit(const glm::vec3& place, const glm::vec3& direction,
                                          float farthest) const {
  const auto hit = scene_.first_hit(place, direction, start_, farthest);
  return hit && glm::dot(face_normals_[hit->face], direction) > 0.0F ? hit : std::nullopt;
}

float Inside::thickness_under(const glm::vec3& place, const glm::vec3& normal) const {
  const glm::mat3 frame = frame_about(-normal);
  std::vector<float> depths;
  for (const glm::vec3& direction : narrow_) {
    const auto hit = exit(place, frame * direction);
    depths.push_back(hit ? hit->distance * direction.z : kNoBody);
  }
  return median(depths);
}

float Inside::thickness_at(const glm::vec3& place, const glm::vec3& normal) const {
  return std::min(thickness_under(place, normal), thickness_under(place, -normal));
}

bool Inside::is_thicker(const glm::vec3& place, const glm::vec3& normal, float limit) const {
  const std::size_t most = narrow_.size() / 2 + 1;  // as many tell where the median is
  const glm::mat3 under = frame_about(-normal);
  std::size_t beyond = 0;
  for (std::size_t k = 0; beyond < most; ++k) {
    if (k - beyond > narrow_.size() - most) return false;
    const auto hit = exit(place, under * narrow_[k]);
    if (hit && hit->distance * narrow_[k].z > limit) ++beyond;
  }
  const glm::mat3 over = frame_about(normal);
  std::size_t within = 0;
  for (std::size_t k = 0; k - within <= narrow_.size() - most; ++k) {
    if (exit(place, over * narrow_[k], limit / narrow_[k].z)) ++within;
    if (within == most) return false;
  }
  return true;
}

std::vector<std::uint32_t> Inside::exits_from(const glm::vec3& place, const glm::vec3& normal) const {
  const glm::mat3 frame = frame_about(-normal);
  std::vector<std::uint32_t> faces;
  for (const glm::vec3& direction : narrow_) {
    if (const auto hit = exit(place, frame * direction)) faces.push_back(hit->face);
  }
  return faces;
}

float Inside::enclosed_at(const glm::vec3& place, const glm::vec3& normal) const {
  const glm::mat3 frame = frame_about(-normal);
  const auto ended = std::ranges::count_if(
      wide_, [&](const glm::vec3& direction) { return exit(place, frame * direction).has_value(); });
  return static_cast<float>(ended) / static_cast<float>(wide_.size());
}

}  // namespace rejoin::mesh::detail
