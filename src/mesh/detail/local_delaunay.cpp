#include "mesh/detail/local_delaunay.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"
#include "core/rigid.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kNearest = 7;  ///< the point itself and the six that surround it in an even cloud
constexpr float kReach = 2.6F;  ///< largest circumscribed circle, in spacings: bridges holes of five spacings
constexpr float kLeastAgreement = -0.35F;  ///< cosine of normals: 110 degrees, a sharp edge and some noise
constexpr float kSteepest = 0.85F;  ///< sine of the angle between a step and the surface that it follows

/// Whether a surface can lead from one point to the other: normals do not oppose each other and the step runs
/// along the surface that they share, not through the body.
bool can_reach(const Mesh& cloud, std::uint32_t from, std::uint32_t to) {
  const glm::vec3& a = cloud.normals[from];
  const glm::vec3& b = cloud.normals[to];
  if (glm::dot(a, b) < kLeastAgreement) return false;
  const glm::vec3 step = cloud.vertices[to] - cloud.vertices[from];
  const glm::vec3 sum = a + b;
  return std::abs(glm::dot(step, sum)) <= kSteepest * glm::length(step) * glm::length(sum);
}

/// One side of a Voronoi cell: the corner that it starts from, and the neighbour beyond it (-1: the outer
/// frame).
struct CellSide {
  glm::dvec2 start;
  int neighbour;
};

/// Voronoi cell of the origin among flat neighbours, cut side by side.
class Cell {
 public:
  explicit Cell(double half) {
    sides_ = {{{-half, -half}, -1}, {{half, -half}, -1}, {{half, half}, -1}, {{-half, half}, -1}};
  }

  /// Cuts the cell to the half plane nearer to the origin than to `site`.
  void cut(const glm::dvec2& site, int neighbour) {
    const double limit = glm::dot(site, site) / 2;
    const auto outside = [&](const CellSide& side) { return glm::dot(side.start, site) - limit; };
    next_.clear();
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const CellSide& here = sides_[i];
      const CellSide& there = sides_[(i + 1) % sides_.size()];
      const double from = outside(here);
      const double to = outside(there);
      if (from <= 0) next_.push_back(here);
      if ((from <= 0) == (to <= 0)) continue;
      const glm::dvec2 crossing = here.start + (there.start - here.start) * (from / (from - to));
      // Leaving the half plane the new side begins; coming back the old one goes on.
      next_.push_back({crossing, from <= 0 ? neighbour : here.neighbour});
    }
    std::swap(sides_, next_);
  }

  double reach() const {
    double furthest = 0;
    for (const CellSide& side : sides_) furthest = std::max(furthest, glm::dot(side.start, side.start));
    return std::sqrt(furthest);
  }

  const std::vector<CellSide>& sides() const { return sides_; }

 private:
  std::vector<CellSide> sides_;
  std::vector<CellSide> next_;
};

/// Works out stars, point by point.
class StarFinder {
 public:
  StarFinder(const Mesh& cloud, const NeighbourLists& wide, std::vector<glm::vec3>& axes,
             std::vector<float>& spacings)
      : cloud_(cloud), wide_(wide), axes_(axes), spacings_(spacings) {}

  /// Mean normal around a point, and the mean distance of the points next to it.
  void describe(std::uint32_t point) {
    const std::span<const std::uint32_t> near = wide_[point].first(std::min(kNearest, wide_.each()));
    glm::vec3 sum(0.0F);
    float distance = 0;
    for (const std::uint32_t other : near) {
      distance += glm::distance(cloud_.vertices[point], cloud_.vertices[other]);
      if (other == point || can_reach(cloud_, point, other)) sum += cloud_.normals[other];
    }
    const float length = glm::length(sum);
    axes_[point] = length > 0 ? sum / length : cloud_.normals[point];
    spacings_[point] = distance / static_cast<float>(std::max<std::size_t>(1, near.size() - 1));
  }

  /// Delaunay star of a point: pairs of neighbours, counter-clockwise about its axis.
  void star(std::uint32_t point, float median_spacing, std::vector<glm::uvec3>& triangles) {
    const double reach = kReach * std::max(spacings_[point], median_spacing);
    const glm::dmat3 frame = frame_of(glm::dvec3(axes_[point]));
    Cell cell(reach);
    for (const std::uint32_t other : wide_[point]) {
      if (other == point || !can_reach(cloud_, point, other)) continue;
      const glm::dvec3 step = glm::dvec3(cloud_.vertices[other]) - glm::dvec3(cloud_.vertices[point]);
      const double distance = glm::length(step);
      if (distance >= 2 * cell.reach()) break;
      const glm::dvec2 flat(glm::dot(step, frame[0]), glm::dot(step, frame[1]));
      const double flat_length = glm::length(flat);
      if (flat_length > 1e-3 * distance) cell.cut(flat * (distance / flat_length), static_cast<int>(other));
    }
    const std::vector<CellSide>& sides = cell.sides();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const int left = sides[i].neighbour;
      const int right = sides[(i + 1) % sides.size()].neighbour;
      if (left < 0 || right < 0 || left == right) continue;
      triangles.emplace_back(point, static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(right));
    }
  }

 private:
  const Mesh& cloud_;
  const NeighbourLists& wide_;
  std::vector<glm::vec3>& axes_;
  std::vector<float>& spacings_;
};

glm::uvec3 sorted(glm::uvec3 t) {
  if (t.x > t.y) std::swap(t.x, t.y);
  if (t.y > t.z) std::swap(t.y, t.z);
  if (t.x > t.y) std::swap(t.x, t.y);
  return t;
}

bool less(const glm::uvec3& a, const glm::uvec3& b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

float circumradius(const Mesh& cloud, const glm::uvec3& t) {
  const glm::dvec3 a(cloud.vertices[t.x]);
  const glm::dvec3 b(cloud.vertices[t.y]);
  const glm::dvec3 c(cloud.vertices[t.z]);
  const double twice_area = glm::length(glm::cross(b - a, c - a));
  return static_cast<float>(glm::distance(a, b) * glm::distance(b, c) * glm::distance(c, a) /
                            (2 * twice_area));
}

/// The triangle wound as the normals of its corners say; nullopt-like false if they do not say it.
bool wind(const Mesh& cloud, glm::uvec3& t) {
  const glm::vec3& a = cloud.vertices[t.x];
  const glm::vec3 cross = glm::cross(cloud.vertices[t.y] - a, cloud.vertices[t.z] - a);
  const float along = glm::dot(cross, cloud.normals[t.x] + cloud.normals[t.y] + cloud.normals[t.z]);
  if (along < 0) std::swap(t.y, t.z);
  return std::abs(along) > 0.2F * glm::length(cross);
}

/// Equal triangles of different stars become one candidate.
std::vector<Candidate> count_votes(const Mesh& cloud, std::vector<glm::uvec3> triangles) {
  for (glm::uvec3& t : triangles) t = sorted(t);
  std::sort(triangles.begin(), triangles.end(), less);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < triangles.size();) {
    std::size_t end = i + 1;
    while (end < triangles.size() && triangles[end] == triangles[i]) ++end;
    Candidate candidate{triangles[i], static_cast<int>(end - i), circumradius(cloud, triangles[i])};
    if (wind(cloud, candidate.corners) && std::isfinite(candidate.radius)) candidates.push_back(candidate);
    i = end;
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.votes != b.votes ? a.votes > b.votes : a.radius < b.radius;
  });
  return candidates;
}

}  // namespace

Neighbourhoods local_delaunay(const Mesh& cloud, const NeighbourLists& wide) {
  const std::size_t count = cloud.vertices.size();
  Neighbourhoods result;
  result.axes.resize(count);
  std::vector<float> spacings(count);
  parallel_for(count, 512, [&](std::size_t first, std::size_t last) {
    StarFinder finder(cloud, wide, result.axes, spacings);
    for (std::size_t i = first; i < last; ++i) finder.describe(static_cast<std::uint32_t>(i));
  });
  std::vector<float> ordered = spacings;
  std::nth_element(ordered.begin(), ordered.begin() + static_cast<std::ptrdiff_t>(count / 2), ordered.end());
  const float median = ordered[count / 2];
  result.spacing = median;

  std::vector<std::vector<glm::uvec3>> stars(count);
  parallel_for(count, 512, [&](std::size_t first, std::size_t last) {
    StarFinder finder(cloud, wide, result.axes, spacings);
    for (std::size_t i = first; i < last; ++i) finder.star(static_cast<std::uint32_t>(i), median, stars[i]);
  });
  std::vector<glm::uvec3> triangles;
  for (const std::vector<glm::uvec3>& star : stars)
    triangles.insert(triangles.end(), star.begin(), star.end());
  result.candidates = count_votes(cloud, std::move(triangles));
  return result;
}

}  // namespace rejoin::mesh::detail
