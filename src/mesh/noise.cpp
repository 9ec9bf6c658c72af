#include "mesh/noise.hpp"

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"
#include "core/rigid.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::mesh {
namespace {

constexpr std::size_t kPlaces = 2000;    // at least, where there are as many points
constexpr std::size_t kNeighbours = 20;  // for the six unknowns of a quadric
constexpr std::size_t kSmoothest = 4;    // one place in so many is smoother

/// Of the points in one place, seen along their plane's normal.
double noise_of(const std::vector<glm::vec3>& points, const std::vector<std::uint32_t>& near) {
  const glm::dmat3 frame = frame_of(glm::dvec3(detail::plane_normal(points, near)));
  const glm::vec3 centre = points[near.front()];
  const auto radius = static_cast<double>(glm::distance(centre, points[near.back()]));
  if (!(radius > 0.0)) return 0.0;
  std::vector<glm::dvec3> local;
  local.reserve(near.size());
  for (const std::uint32_t k : near) local.push_back(glm::dvec3(points[k] - centre) * frame / radius);
  return radius * detail::quadric_residual(local);
}

}  // namespace

double noise(const Mesh& mesh) {
  const std::vector<glm::vec3>& points = mesh.vertices;
  if (points.size() < kNeighbours) return 0.0;
  const PointIndex index(points);
  const std::size_t step = std::max<std::size_t>(1, points.size() / kPlaces);
  std::vector<double> places(points.size() / step);
  parallel_for(places.size(), 64, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t k = first; k < last; ++k) {
      index.nearest(points[k * step], kNeighbours, near);
      places[k] = noise_of(points, near);
    }
  });
  const auto quarter = places.begin() + static_cast<std::ptrdiff_t>(places.size() / kSmoothest);
  std::nth_element(places.begin(), quarter, places.end());
  return *quarter;
}

}  // namespace rejoin::mesh
