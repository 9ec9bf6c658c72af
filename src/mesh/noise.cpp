#include "mesh/noise.hpp"

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"
#include "core/rigid.hpp"
#include "mesh/area_normals.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

constexpr std::size_t kPlaces = 2000;  // at least, where there are as many points
constexpr std::size_t kNeighbours = 20;
constexpr std::size_t kSurroundings = 20;    // a scan has as many at least, if they are to be small
constexpr std::size_t kMoreNeighbours = 45;  // within 1.5 times the radius
constexpr double kAlike = 1.3;         // noise grows by 1.08 to 1.12, shape by 1.5 to 2.9 (docs/scoring.md)
constexpr std::size_t kEnough = 12;    // for the six unknowns of a quadric
constexpr std::size_t kSmoothest = 4;  // one place in so many is smoother

/// Of points in one place, the first in their middle, seen along the normal of their plane.
double noise_of(const std::vector<glm::vec3>& points, const std::vector<std::uint32_t>& near) {
  const glm::vec3 middle = points[near.front()];
  const auto radius = static_cast<double>(glm::distance(middle, points[near.back()]));
  if (!(radius > 0.0)) return 0.0;
  const glm::dmat3 frame = frame_of(glm::dvec3(detail::plane_normal(points, near)));
  std::vector<glm::dvec3> local;
  local.reserve(near.size());
  for (const std::uint32_t k : near) local.push_back(glm::dvec3(points[k] - middle) * frame / radius);
  return radius * detail::quadric_residual(local);
}

/// noise() by quadrics through so many points.
double noise_over(const Mesh& mesh, std::size_t count) {
  const std::vector<glm::vec3>& points = mesh.vertices;
  const std::vector<glm::vec3> normals = area_normals(mesh);
  const PointIndex index(points);
  const std::size_t step = std::max<std::size_t>(1, points.size() / kPlaces);
  std::vector<double> places(points.size() / step, -1.0);
  parallel_for(places.size(), 64, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t k = first; k < last; ++k) {
      const auto here = static_cast<std::uint32_t>(k * step);
      index.nearest(points[here], count, near);
      std::erase_if(near, [&](std::uint32_t i) { return !(glm::dot(normals[i], normals[here]) > 0.0F); });
      if (near.size() >= kEnough) places[k] = noise_of(points, near);
    }
  });
  std::erase_if(places, [](double place) { return place < 0.0; });
  if (places.empty()) return 0.0;
  const auto quarter = places.begin() + static_cast<std::ptrdiff_t>(places.size() / kSmoothest);
  std::nth_element(places.begin(), quarter, places.end());
  return *quarter;
}

}  // namespace

double noise(const Mesh& mesh) {
  return noise_over(mesh, kNeighbours);
}

bool is_of_scanner(double noise, const Mesh& mesh) {
  if (mesh.vertices.size() < kSurroundings * kMoreNeighbours) return false;
  return noise_over(mesh, kMoreNeighbours) < kAlike * noise;
}

}  // namespace rejoin::mesh
