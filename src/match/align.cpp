#include "match/align.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "mesh/point_index.hpp"

namespace rejoin::match {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr float kFacing = -0.5F;     // facing normals differ from opposite by at most 60 degrees
constexpr double kWallNear = 1.2;    // wall thicknesses from the seam in which walls are compared
constexpr double kWallClear = 0.25;  // wall thicknesses next to the seam that are left out: worn edges lie
constexpr float kWallAlike = 0.7F;   // wall normals across a seam differ by at most 45 degrees
constexpr double kWallWeight = 0.3;

/// Samples of one class of one fragment.
struct Cloud {
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> relief;  ///< normal less the smoothed course of the surface around it
};

struct Side {
  Cloud broken;
  Cloud walls;  ///< thin pieces: original surface near the fracture
  std::unique_ptr<mesh::PointIndex> broken_index;
  std::unique_ptr<mesh::PointIndex> wall_index;
  double sample_area = 0;
};

glm::vec3 apply(const glm::mat3& r, const glm::vec3& t, const glm::vec3& p) {
  return r * p + t;
}

Side side_of(const Fragment& fragment, double course_radius) {
  const auto& s = fragment.facets;
  Side side;
  side.sample_area = s.sample_area;
  const bool thin = s.wall_thickness > 0;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (s.surface[i] != mesh::Surface::Fracture) continue;
    side.broken.points.push_back(s.samples.points[i]);
    side.broken.normals.push_back(s.normals[i]);
  }
  side.broken_index = std::make_unique<mesh::PointIndex>(side.broken.points);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < side.broken.points.size(); ++i) {
    side.broken_index->within(side.broken.points[i], static_cast<float>(course_radius), near);
    glm::vec3 sum(0.0F);
    for (const auto k : near) {
      if (glm::dot(side.broken.normals[k], side.broken.normals[i]) > 0.0F) sum += side.broken.normals[k];
    }
    side.broken.relief.push_back(side.broken.normals[i] - glm::normalize(sum));
  }
  if (thin) {
    for (std::size_t i = 0; i < s.samples.size(); ++i) {
      if (s.surface[i] != mesh::Surface::Original) continue;
      const auto seam = side.broken_index->nearest(s.samples.points[i]);
      if (!seam || seam->second < kWallClear * s.wall_thickness ||
          seam->second > kWallNear * s.wall_thickness)
        continue;
      side.walls.points.push_back(s.samples.points[i]);
      side.walls.normals.push_back(s.normals[i]);
    }
  }
  side.wall_index = std::make_unique<mesh::PointIndex>(side.walls.points);
  return side;
}

/// Normal equations of the rigid motion x -> x + w x (x - pivot) + t that best closes the given offsets.
struct System {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double weight = 0;

  void add(const glm::dvec3& arm, const glm::dvec3& normal, double offset, double w) {
    const glm::dvec3 turn = glm::cross(arm, normal);
    Vector6 row;
    row << turn.x, turn.y, turn.z, normal.x, normal.y, normal.z;
    matrix += w * row * row.transpose();
    right -= w * offset * row;
    weight += w;
  }
};

double tukey(double offset, double scale) {
  const double r = offset / scale;
  if (std::abs(r) >= 1.0) return 0.0;
  const double k = 1.0 - r * r;
  return k * k;
}

Rigid moved(const Rigid& pose, const Vector6& step, const glm::dvec3& pivot) {
  const glm::dvec3 turn(step[0], step[1], step[2]);
  const double angle = glm::length(turn);
  const glm::dmat3 rotation = angle > 1e-12 ? axis_rotation(turn / angle, angle) : glm::dmat3(1.0);
  const glm::dvec3 shift(step[3], step[4], step[5]);
  return Rigid{rotation, pivot + shift - rotation * pivot} * pose;
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

struct Joint::Impl {
  Side a;
  Side b;
  double thickness = 0;
  double spacing = 0;
  double tolerance = 0;
  glm::dvec3 low_b{0.0};

  struct Match {
    std::uint32_t of_a;
    float distance;
  };

  /// B's samples that lie within `reach` of A's box can matter; every nth of them if there are more than
  /// `most`.
  std::vector<std::uint32_t> chosen(const Cloud& cloud, const mesh::PointIndex& index, const Rigid& pose,
                                    double reach, int most) const {
    const glm::mat3 r(pose.rotation);
    const glm::vec3 t(pose.translation);
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
      const auto hit = index.nearest(apply(r, t, cloud.points[i]));
      if (hit && static_cast<double>(hit->second) < reach) list.push_back(i);
    }
    if (most > 0 && list.size() > static_cast<std::size_t>(most)) {
      std::vector<std::uint32_t> fewer;
      const double step = static_cast<double>(list.size()) / most;
      for (int k = 0; k < most; ++k) fewer.push_back(list[static_cast<std::size_t>(k * step)]);
      list.swap(fewer);
    }
    return list;
  }

  void add_broken(System& system, const Rigid& pose, const glm::dvec3& pivot,
                  const std::vector<std::uint32_t>& list, double reach) const {
    const glm::mat3 r(pose.rotation);
    const glm::vec3 t(pose.translation);
    for (const auto i : list) {
      const glm::vec3 p = apply(r, t, b.broken.points[i]);
      const auto hit = a.broken_index->nearest(p);
      if (!hit || static_cast<double>(hit->second) > 1.5 * reach) continue;
      const glm::vec3 n = a.broken.normals[hit->first];
      if (glm::dot(n, r * b.broken.normals[i]) > kFacing) continue;
      const auto offset = static_cast<double>(glm::dot(p - a.broken.points[hit->first], n));
      system.add(glm::dvec3(p) - pivot, glm::dvec3(n), offset, tukey(offset, reach));
    }
  }

  /// Walls continue across the seam: (p - q).(n_p + n_q) vanishes on planes, cylinders and spheres.
  void add_walls(System& system, const Rigid& pose, const glm::dvec3& pivot,
                 const std::vector<std::uint32_t>& list, double reach) const {
    const glm::mat3 r(pose.rotation);
    const glm::vec3 t(pose.translation);
    for (const auto i : list) {
      const glm::vec3 p = apply(r, t, b.walls.points[i]);
      const auto hit = a.wall_index->nearest(p);
      if (!hit || static_cast<double>(hit->second) > kWallNear * thickness) continue;
      const glm::vec3 n_b = r * b.walls.normals[i];
      const glm::vec3 n_a = a.walls.normals[hit->first];
      if (glm::dot(n_a, n_b) < kWallAlike) continue;
      const glm::dvec3 n = glm::normalize(glm::dvec3(n_a + n_b));
      const double offset = glm::dot(glm::dvec3(p - a.walls.points[hit->first]), n);
      system.add(glm::dvec3(p) - pivot, n, offset, kWallWeight * tukey(offset, reach));
    }
  }
};

Joint::Joint(const Fragment& a, const Fragment& b) : impl_(std::make_unique<Impl>()) {
  Impl& d = *impl_;
  const double ta = a.facets.wall_thickness;
  const double tb = b.facets.wall_thickness;
  d.thickness = ta > 0 && tb > 0 ? std::min(ta, tb) : 0.0;
  d.spacing = std::max(a.facets.samples.spacing, b.facets.samples.spacing);
  const double scan = std::max(a.resolution, b.resolution);
  d.tolerance = std::max(d.thickness > 0 ? 0.1 * d.thickness : 0.3 * d.spacing, 0.75 * scan);
  const double course = std::max(d.thickness, 6.0 * d.spacing);
  d.a = side_of(a, course);
  d.b = side_of(b, course);
}

Joint::~Joint() = default;

double Joint::tolerance() const {
  return impl_->tolerance;
}

Rigid Joint::align(const Rigid& start, const AlignOptions& options) const {
  const Impl& d = *impl_;
  Rigid pose = start;
  const auto list =
      d.chosen(d.b.broken, *d.a.broken_index, pose, 2.0 * options.reach_start, options.most_samples);
  const auto walls = d.thickness > 0
                         ? d.chosen(d.b.walls, *d.a.wall_index, pose,
                                    kWallNear * d.thickness + options.reach_start, options.most_samples)
                         : std::vector<std::uint32_t>{};
  if (list.size() < 12) return pose;
  for (int k = 0; k < options.iterations; ++k) {
    const double part = options.iterations > 1 ? static_cast<double>(k) / (options.iterations - 1) : 1.0;
    const double reach = options.reach_start * std::pow(options.reach_end / options.reach_start, part);
    glm::dvec3 pivot(0.0);
    for (const auto i : list) pivot += pose(glm::dvec3(d.b.broken.points[i]));
    pivot /= static_cast<double>(list.size());
    System system;
    d.add_broken(system, pose, pivot, list, reach);
    if (system.weight < 6.0) break;
    if (d.thickness > 0) d.add_walls(system, pose, pivot, walls, reach);
    // A little resistance keeps directions still that nothing holds (sliding on a plane).
    const double arm = 10.0 * d.spacing;
    for (int q = 0; q < 6; ++q) system.matrix(q, q) += 1e-3 * system.weight * (q < 3 ? arm * arm : 1.0);
    pose = moved(pose, system.matrix.ldlt().solve(system.right), pivot);
  }
  return pose;
}

Evidence Joint::evidence(const Rigid& pose) const {
  const Impl& d = *impl_;
  const glm::mat3 r(pose.rotation);
  const glm::vec3 t(pose.translation);
  Evidence e;
  std::vector<double> gaps;
  double cross = 0.0;
  double own = 0.0;
  double left = 0.0;
  double depth = 0.0;
  double inside = 0.0;
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  const double over = 4.0 * d.tolerance;
  for (std::size_t i = 0; i < d.b.broken.points.size(); ++i) {
    const glm::vec3 p = apply(r, t, d.b.broken.points[i]);
    const auto hit = d.a.broken_index->nearest(p);
    if (!hit) continue;
    const glm::vec3 n = d.a.broken.normals[hit->first];
    const glm::vec3 offset = p - d.a.broken.points[hit->first];
    const auto gap = static_cast<double>(glm::dot(offset, n));
    const double aside = std::sqrt(std::max(0.0, static_cast<double>(glm::dot(offset, offset)) - gap * gap));
    if (aside > d.spacing || std::abs(gap) > 3.0 * over) continue;
    if (glm::dot(n, r * d.b.broken.normals[i]) > kFacing) continue;
    if (std::abs(gap) < over) e.shared_area += d.b.sample_area;
    if (gap < -2.0 * d.tolerance) {
      inside += 1.0;
      depth -= gap;
    }
    if (std::abs(gap) > d.tolerance) continue;
    gaps.push_back(gap);
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
    const glm::vec3 relief_a = d.a.broken.relief[hit->first];
    const glm::vec3 relief_b = r * d.b.broken.relief[i];
    cross -= 2.0 * static_cast<double>(glm::dot(relief_a, relief_b));
    own += static_cast<double>(glm::dot(relief_a, relief_a) + glm::dot(relief_b, relief_b));
    const glm::vec3 sum = relief_a + relief_b;
    left += static_cast<double>(glm::dot(sum, sum));
  }
  const auto count = static_cast<double>(gaps.size());
  e.contact_area = count * d.b.sample_area;
  e.penetration_area = inside * d.b.sample_area;
  e.penetration = inside > 0 ? depth / inside : 0.0;
  if (count > 0) {
    e.explained = cross / (own + 2.0 * count * 0.02 * 0.02);
    e.relief = std::sqrt(0.5 * own / count);
    e.residual = std::sqrt(left / count);
    e.length = glm::length(high - low);
    e.gap_median = median(gaps);
    for (double& g : gaps) g = std::abs(g - e.gap_median);
    e.gap_spread = median(gaps);
  }
  if (d.thickness > 0) {
    double squares = 0.0;
    double bend = 0.0;
    double found = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < d.b.walls.points.size(); ++i) {
      const glm::vec3 p = apply(r, t, d.b.walls.points[i]);
      const auto seam = d.a.broken_index->nearest(p);
      if (!seam || static_cast<double>(seam->second) > kWallNear * d.thickness) continue;
      all += 1.0;
      const auto hit = d.a.wall_index->nearest(p);
      if (!hit || static_cast<double>(hit->second) > 2.0 * kWallNear * d.thickness) continue;
      const glm::dvec3 n_b(r * d.b.walls.normals[i]);
      const glm::dvec3 n_a(d.a.walls.normals[hit->first]);
      if (glm::dot(n_a, n_b) < 0.5) continue;
      const double offset = glm::dot(glm::dvec3(p - d.a.walls.points[hit->first]), glm::normalize(n_a + n_b));
      if (std::abs(offset) > 0.5 * d.thickness) continue;
      squares += offset * offset;
      bend += std::acos(std::min(1.0, glm::dot(n_a, n_b)));
      found += 1.0;
    }
    if (found > 0) {
      e.wall_step = std::sqrt(squares / found);
      e.wall_bend = bend / found;
    }
    e.wall_share = all > 0 ? found / all : 0.0;
  }
  return e;
}

}  // namespace rejoin::match
