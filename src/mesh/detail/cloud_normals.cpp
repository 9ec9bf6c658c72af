#include "mesh/detail/cloud_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/parallel.hpp"
#include "mesh/detail/agreeing_normals.hpp"
#include "mesh/detail/directions.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/detail/outlook.hpp"
#include "mesh/detail/surface_of_cloud.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kAxes = 32;   // and their opposites
constexpr float kOpposite = -0.5F;  // cosine of normals
constexpr double kStray = 5e-4;     // share of neighbours with opposite normals that a cloud is let pass with
constexpr double kAgreeing = 0.95;  // share of good normals that turning along the surface leaves, or turns
constexpr double kBetter = 0.2;     // of all rays, that leave from the front and not from the back

/// Whether the normals at the furthest points in all directions point inwards, taken together.
bool points_inwards(const std::vector<std::uint32_t>& part, const std::vector<glm::vec3>& points,
                    const std::vector<glm::vec3>& normals) {
  float outwards = 0;
  const auto look = [&](const glm::vec3& direction) {
    std::uint32_t furthest = part.front();
    float most = -std::numeric_limits<float>::infinity();
    for (const std::uint32_t i : part) {
      const float along = glm::dot(direction, points[i]);
      if (along > most) {
        most = along;
        furthest = i;
      }
    }
    outwards += glm::dot(direction, normals[furthest]);
  };
  for (const glm::vec3& direction : half_sphere_directions(kAxes)) {
    look(direction);
    look(-direction);
  }
  return outwards < 0;
}

void turn_outwards(const NeighbourLists& lists, const std::vector<glm::vec3>& points,
                   std::vector<glm::vec3>& normals, const std::vector<float>& variation) {
  for (const std::vector<std::uint32_t>& part : make_normals_agree(points, lists, variation, normals)) {
    if (!points_inwards(part, points, normals)) continue;
    for (const std::uint32_t i : part) normals[i] = -normals[i];
  }
}

/// Share of neighbours whose normals point opposite ways: hardly any, but on both sides of a wall as thin as the points lie apart.
double opposite_share(const std::vector<glm::vec3>& normals, const NeighbourLists& near) {
  std::size_t opposite = 0;
  std::size_t all = 0;
  for (std::uint32_t i = 0; i < normals.size(); ++i) {
    for (const std::uint32_t k : near[i]) opposite += glm::dot(normals[i], normals[k]) < kOpposite ? 1 : 0;
    all += near[i].size();
  }
  return static_cast<double>(opposite) / static_cast<double>(all);
}

/// Share of normals that are the same both times, or turned, whichever are more.
double agreement(const std::vector<glm::vec3>& before, const std::vector<glm::vec3>& after) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < before.size(); ++i) same += glm::dot(before[i], after[i]) > 0 ? 1 : 0;
  const double share = static_cast<double>(same) / static_cast<double>(before.size());
  return std::max(share, 1 - share);
}

/// What can be seen from the surface through a cloud.
Outlook outlook_of(const Mesh& cloud, CloudNeighbours& neighbours) {
  const Mesh surface = surface_of_cloud(cloud, neighbours);
  if (surface.faces.empty() || !(surface_area(surface) > 0)) return {};
  return outlook(surface);
}

/// Whether the points lie in front of their normals' planes through the centre, on the whole, or behind them.
double swelling(const Mesh& cloud) {
  const glm::vec3 centre = centroid(cloud);
  double sum = 0;
  for (std::size_t i = 0; i < cloud.vertices.size(); ++i)
    sum += static_cast<double>(glm::dot(cloud.vertices[i] - centre, cloud.normals[i]));
  return sum;
}

}  // namespace

std::vector<glm::vec3> estimate_normals(const std::vector<glm::vec3>& points, const NeighbourLists& near) {
  std::vector<glm::vec3> normals(points.size());
  std::vector<float> variation(points.size());
  parallel_for(points.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const PlaneFit plane = fit_plane(points, near[i]);
      normals[i] = plane.normal;
      variation[i] = plane.variation;
    }
  });
  turn_outwards(near, points, normals, variation);
  return normals;
}

NormalsFound check_normals(Mesh& cloud, CloudNeighbours& neighbours) {
  const NeighbourLists& near = neighbours.near();
  if (opposite_share(cloud.normals, near) > kStray) {
    Mesh turned = cloud;
    turn_outwards(near, turned.vertices, turned.normals, {});
    if (agreement(cloud.normals, turned.normals) < kAgreeing) {
      const Outlook before = outlook_of(cloud, neighbours);
      const Outlook after = outlook_of(turned, neighbours);
      if (after.front - after.back > before.front - before.back + kBetter) {
        cloud.normals = std::move(turned.normals);
        return NormalsFound::Mixed;
      }
    }
  }
  if (swelling(cloud) >= 0 || !is_inside_out(outlook_of(cloud, neighbours))) return NormalsFound::Good;
  for (glm::vec3& normal : cloud.normals) normal = -normal;
  return NormalsFound::InsideOut;
}

}  // namespace rejoin::mesh::detail
