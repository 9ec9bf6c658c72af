#include "rims/rim.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"
#include "core/smooth.hpp"
#include "mesh/point_index.hpp"
#include "rims/closed_curve.hpp"

namespace rejoin::rims {
namespace {

constexpr std::size_t kVoters = 8;        // samples that say what a vertex is
constexpr std::size_t kWallSamples = 12;  // of original surface, that give the wall's normal at a place
// How far inside the wall's normals are taken.
constexpr double kInsideSpacings = 4.0;
constexpr double kInsideWalls = 0.7;
constexpr std::size_t kLeastPoints = 24;
constexpr double kShortest = 0.1;   // of the longest rim
constexpr double kThickest = 3.0;   // walls
constexpr double kOpposite = -0.3;  // cosine of the two walls' normals, at most

glm::dvec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

/// How much of the surface around each vertex is original: 1 all, -1 none.
std::vector<float> originality(const mesh::Segmentation& facets, const mesh::Mesh& mesh) {
  const mesh::PointIndex index(facets.samples.points);
  const double spread = 2.0 * facets.samples.spacing * facets.samples.spacing;
  std::vector<float> values(mesh.vertices.size(), -1.0F);
  parallel_for(values.size(), 512, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> near;
    for (std::size_t v = first; v < last; ++v) {
      index.nearest(mesh.vertices[v], kVoters, near);
      double sum = 0.0;
      double weights = 0.0;
      for (const std::uint32_t i : near) {
        const glm::dvec3 off(facets.samples.points[i] - mesh.vertices[v]);
        const double weight = std::exp(-glm::dot(off, off) / spread) + 1e-9;
        sum += facets.surface[i] == mesh::Surface::Original ? weight : -weight;
        weights += weight;
      }
      values[v] = weights > 0.0 ? static_cast<float>(sum / weights) : -1.0F;
    }
  });
  return values;
}

/// Original surface alone, to ask for its normal.
struct Wall {
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;

  explicit Wall(const mesh::Segmentation& facets) {
    for (std::size_t i = 0; i < facets.samples.size(); ++i) {
      if (facets.surface[i] != mesh::Surface::Original) continue;
      points.push_back(facets.samples.points[i]);
      normals.push_back(facets.normals[i]);
    }
  }
};

/// Mean normal of the wall around a place, of the wall that `side` is the normal of.
glm::dvec3 wall_normal(const glm::dvec3& place, const glm::dvec3& side, const Wall& wall,
                       const mesh::PointIndex& index, std::vector<std::uint32_t>& near) {
  index.nearest(glm::vec3(place), kWallSamples, near);
  glm::dvec3 mean(0.0);
  for (const std::uint32_t i : near) {
    const glm::dvec3 normal(wall.normals[i]);
    if (glm::dot(normal, side) > 0.0) mean += normal;
  }
  return unit(mean);
}

/// The wall's normals along a curve, smoothed like the curve and perpendicular to it.  Edges are worn round and lean
/// towards the break, so the normals are looked at further inside, twice, and continued to the edge in a straight line.
std::vector<glm::dvec3> wall_normals(const ClosedCurve& curve, const std::vector<glm::dvec3>& along,
                                     const Wall& wall, const mesh::PointIndex& index, double inside,
                                     double smoothing) {
  ClosedCurve normals;
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto nearest = index.nearest(glm::vec3(curve[i]));
    const glm::dvec3 at_edge(wall.normals[nearest->first]);
    const glm::dvec3 inwards = inside * unit(glm::cross(at_edge, along[i]));
    const glm::dvec3 first = wall_normal(curve[i] + inwards, at_edge, wall, index, near);
    const glm::dvec3 second = wall_normal(curve[i] + 2.0 * inwards, at_edge, wall, index, near);
    normals.push_back(unit(2.0 * first - second));
  }
  normals = smooth(normals, smoothing);
  for (std::size_t i = 0; i < normals.size(); ++i)
    normals[i] = unit(normals[i] - glm::dot(normals[i], along[i]) * along[i]);
  return normals;
}

Rim described(const ClosedCurve& curve, const Wall& wall, const mesh::PointIndex& index, double inside,
              double smoothing) {
  const std::size_t count = curve.size();
  const auto at = [&](std::size_t i, std::size_t ahead) { return (i + ahead) % count; };
  std::vector<glm::dvec3> along;
  along.reserve(count);
  for (std::size_t i = 0; i < count; ++i) along.push_back(unit(curve[at(i, 1)] - curve[at(i, count - 1)]));
  const std::vector<glm::dvec3> normals = wall_normals(curve, along, wall, index, inside, smoothing);
  Rim rim;
  rim.step = length_of(curve) / static_cast<double>(count);
  rim.points.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    RimPoint& point = rim.points[i];
    const glm::dvec3 left = glm::cross(normals[i], along[i]);
    const glm::dvec3 change = 0.5 * (along[at(i, 1)] - along[at(i, count - 1)]);
    const glm::dvec3 tilt = 0.5 * (normals[at(i, 1)] - normals[at(i, count - 1)]);
    point = {curve[i],
             along[i],
             normals[i],
             glm::dot(change, left),
             glm::dot(change, normals[i]),
             glm::dot(tilt, left),
             0.0};
  }
  return rim;
}

/// Distance to the nearest rim of the opposite wall: the width of the broken band.
void measure_thickness(std::vector<Rim>& rims, double wall_thickness) {
  if (wall_thickness <= 0.0) return;
  const double most = kThickest * wall_thickness;
  std::vector<glm::vec3> places;
  std::vector<glm::dvec3> walls;
  for (const Rim& rim : rims) {
    for (const RimPoint& point : rim.points) {
      places.emplace_back(point.place);
      walls.push_back(point.wall);
    }
  }
  const mesh::PointIndex index(places);
  std::vector<std::uint32_t> near;
  for (Rim& rim : rims) {
    for (RimPoint& point : rim.points) {
      point.thickness = most;
      index.within(glm::vec3(point.place), static_cast<float>(most), near);
      for (const std::uint32_t i : near) {
        if (glm::dot(walls[i], point.wall) < kOpposite)
          point.thickness = std::min(point.thickness, glm::distance(glm::dvec3(places[i]), point.place));
      }
    }
  }
}

}  // namespace

std::vector<Rim> find_rims(const match::Fragment& fragment, double step, double smoothing) {
  const Wall wall(fragment.facets);
  if (wall.points.size() < kWallSamples) return {};
  const mesh::PointIndex index(wall.points);
  std::vector<std::pair<double, ClosedCurve>> curves;
  for (ClosedCurve& curve : zero_curves(fragment.surface, originality(fragment.facets, fragment.surface))) {
    const double length = length_of(curve);
    curves.emplace_back(length, std::move(curve));
  }
  std::stable_sort(curves.begin(), curves.end(),
                   [](const auto& p, const auto& q) { return p.first > q.first; });
  const double inside = std::max(kInsideSpacings * fragment.facets.samples.spacing,
                                 kInsideWalls * fragment.facets.wall_thickness);
  std::vector<Rim> rims;
  for (const auto& [length, curve] : curves) {
    const auto count = static_cast<std::size_t>(std::llround(length / step));
    if (length < kShortest * curves.front().first || count < kLeastPoints) break;
    rims.push_back(described(smooth(resampled(curve, count), smoothing), wall, index, inside, smoothing));
  }
  measure_thickness(rims, fragment.facets.wall_thickness);
  return rims;
}

}  // namespace rejoin::rims
