#include "match/align.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "core/median.hpp"
#include "match/verify.hpp"
#include "mesh/near_table.hpp"
#include "mesh/point_index.hpp"

namespace rejoin::match {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr float kFacing = -0.5F;     // facing normals differ from opposite by at most 60 degrees
constexpr int kBodySamples = 4000;   // of B that are asked whether they lie inside A
constexpr double kWallNear = 1.2;    // wall thicknesses from the seam in which walls are compared
constexpr double kWallClear = 0.25;  // wall thicknesses next to the seam that are left out: worn edges lie
constexpr float kWallAlike = 0.7F;   // wall normals across a seam differ by at most 45 degrees
constexpr double kWallWeight = 0.1;
constexpr double kWallStep = 0.3;        // wall thicknesses by which walls that go on may be offset
constexpr double kTableCell = 2.0;       // spacings: side of the cells of tables of near points
constexpr double kTableReach = 20.0;     // tolerances: how far a quick alignment looks
constexpr double kWallTableCell = 3.0;   // the same for walls, which are smooth
constexpr int kQuadricRounds = 12;       // at most
constexpr double kQuadricSteady = 0.02;  // share by which the deviation may still change in the end
constexpr double kQuadricReach = 7.0;    // robust deviations beyond which a height does not bend the quadric

/// Samples of one class of one fragment.
struct Cloud {
  std::vector<glm::vec3> points;
  std::vector<glm::vec3> normals;
  std::vector<bool> edge;  ///< next to another facet: worn, of no use for the relief
};

/// Looks for the point of a cloud that is nearest to another.
class Finder {
 public:
  /// \param table  for nearly the nearest point, sooner; nullptr: exactly
  Finder(const mesh::PointIndex& index, const mesh::NearTable* table) : index_(&index), table_(table) {}

  std::optional<std::pair<std::uint32_t, float>> within(const glm::vec3& point, double radius) const {
    const auto r = static_cast<float>(radius);
    return table_ != nullptr ? table_->nearest_within(point, r) : index_->nearest_within(point, r);
  }

 private:
  const mesh::PointIndex* index_;
  const mesh::NearTable* table_;
};

struct Side {
  Cloud broken;
  Cloud walls;  ///< thin pieces: original surface near the fracture
  Cloud body;   ///< every sample
  std::unique_ptr<mesh::PointIndex> broken_index;
  std::unique_ptr<mesh::PointIndex> wall_index;
  std::unique_ptr<mesh::PointIndex> body_index;
  std::vector<std::uint32_t> all_walls;                     ///< 0, 1, ... into `walls`
  std::vector<std::uint32_t> all_broken;                    ///< 0, 1, ... into `broken`
  std::vector<std::vector<std::uint32_t>> broken_of_facet;  ///< into `broken`
  double sample_area = 0;

  /// The broken samples of one facet; of all for -1.
  const std::vector<std::uint32_t>& broken_of(int facet) const {
    return facet < 0 ? all_broken : broken_of_facet[static_cast<std::size_t>(facet)];
  }
};

glm::vec3 apply(const glm::mat3& r, const glm::vec3& t, const glm::vec3& p) {
  return r * p + t;
}

Side side_of(const Fragment& fragment, double edge_radius) {
  const auto& s = fragment.facets;
  Side side;
  side.sample_area = s.sample_area;
  side.body.points = s.samples.points;
  side.body.normals = s.normals;
  side.body_index = std::make_unique<mesh::PointIndex>(side.body.points);
  side.broken_of_facet.resize(s.facets.size());
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    if (s.surface[i] != mesh::Surface::Fracture) continue;
    const auto number = static_cast<std::uint32_t>(side.broken.points.size());
    side.all_broken.push_back(number);
    if (s.facet_of_sample[i] >= 0) {
      side.broken_of_facet[static_cast<std::size_t>(s.facet_of_sample[i])].push_back(number);
    }
    side.broken.points.push_back(s.samples.points[i]);
    side.broken.normals.push_back(s.normals[i]);
    side.body_index->within(s.samples.points[i], static_cast<float>(edge_radius), near);
    side.broken.edge.push_back(std::any_of(near.begin(), near.end(), [&](std::uint32_t k) {
      return s.facet_of_sample[k] != s.facet_of_sample[i];
    }));
  }
  side.broken_index = std::make_unique<mesh::PointIndex>(side.broken.points);
  if (s.wall_thickness > 0) {
    for (std::size_t i = 0; i < s.samples.size(); ++i) {
      if (s.surface[i] != mesh::Surface::Original) continue;
      const auto seam = side.broken_index->nearest_within(s.samples.points[i],
                                                          static_cast<float>(kWallNear * s.wall_thickness));
      if (!seam || seam->second < kWallClear * s.wall_thickness) continue;
      side.all_walls.push_back(static_cast<std::uint32_t>(side.walls.points.size()));
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

/// Step that visits at most `most` of `count` items; most <= 0: all.
std::size_t stride(std::size_t count, int most) {
  return most > 0 ? std::max<std::size_t>(1, count / static_cast<std::size_t>(most)) : 1;
}

}  // namespace

struct Joint::Impl {
  /// Of A.
  struct Tables {
    mesh::NearTable broken;
    mesh::NearTable walls;
    mesh::NearTable body;
  };

  Impl(std::shared_ptr<const Side> of_a, std::shared_ptr<const Side> of_b)
      : held_a(std::move(of_a)), held_b(std::move(of_b)), a(*held_a), b(*held_b) {}

  std::shared_ptr<const Side> held_a;
  std::shared_ptr<const Side> held_b;
  const Side& a;
  const Side& b;
  mutable Tables tables;
  mutable std::once_flag made_tables;
  double thickness = 0;
  double spacing = 0;
  double tolerance = 0;
  double noise = 0;  ///< of the scans, mesh units
  double patch = 0;  ///< side of a patch of surface whose relief is independent of the next one's, mesh units

  /// How deep a body's surface can lie in the other one's, mesh units.
  double deepest() const { return thickness > 0 ? 0.6 * thickness : 8.0 * spacing; }

  /// Looks for points of A: broken surface, walls, all.
  Finder broken_finder(bool quick) const {
    return {*a.broken_index, quick ? &ready_tables().broken : nullptr};
  }
  Finder wall_finder(bool quick) const { return {*a.wall_index, quick ? &ready_tables().walls : nullptr}; }
  Finder body_finder(bool quick) const { return {*a.body_index, quick ? &ready_tables().body : nullptr}; }

  const Tables& ready_tables() const {
    std::call_once(made_tables, [this] {
      const auto table = [](const Cloud& cloud, double cell, double reach) {
        return mesh::NearTable(cloud.points, static_cast<float>(cell), static_cast<float>(reach));
      };
      const double near = kWallNear * thickness;
      tables.broken = table(a.broken, kTableCell * spacing, std::max(kTableReach * tolerance, near));
      tables.body = table(a.body, kTableCell * spacing, deepest());
      if (thickness > 0) {
        tables.walls = table(a.walls, kWallTableCell * spacing, near + 0.5 * kTableReach * tolerance);
      }
    });
    return tables;
  }

  /// B's samples that lie within `reach` of A's box can matter; every nth of them if there are more than
  /// `most`.
  std::vector<std::uint32_t> chosen(const Cloud& cloud, const std::vector<std::uint32_t>& from,
                                    const Finder& finder, const Rigid& pose, double reach, int most) const {
    const glm::mat3 r(pose.rotation);
    const glm::vec3 t(pose.translation);
    std::vector<std::uint32_t> list;
    const std::size_t step = stride(from.size(), 8 * most);
    for (std::size_t i = 0; i < from.size(); i += step) {
      if (finder.within(apply(r, t, cloud.points[from[i]]), reach)) list.push_back(from[i]);
    }
    if (most > 0 && list.size() > static_cast<std::size_t>(most)) {
      std::vector<std::uint32_t> fewer;
      fewer.reserve(static_cast<std::size_t>(most));
      const double step = static_cast<double>(list.size()) / most;
      for (int k = 0; k < most; ++k) fewer.push_back(list[static_cast<std::size_t>(k * step)]);
      list.swap(fewer);
    }
    return list;
  }

  void add_broken(System& system, const Rigid& pose, const glm::dvec3& pivot,
                  const std::vector<std::uint32_t>& list, double reach, const AlignOptions& options) const {
    const glm::mat3 r(pose.rotation);
    const glm::vec3 t(pose.translation);
    const Finder finder = broken_finder(options.quick);
    for (const auto i : list) {
      if (options.core_only && b.broken.edge[i]) continue;
      const glm::vec3 p = apply(r, t, b.broken.points[i]);
      const auto hit = finder.within(p, 1.5 * reach);
      if (!hit || (options.core_only && a.broken.edge[hit->first])) continue;
      const glm::vec3 n = a.broken.normals[hit->first];
      if (glm::dot(n, r * b.broken.normals[i]) > kFacing) continue;
      const auto offset = static_cast<double>(glm::dot(p - a.broken.points[hit->first], n));
      system.add(glm::dvec3(p) - pivot, glm::dvec3(n), offset, tukey(offset, reach));
    }
  }

  /// Walls continue across the seam: (p - q).(n_p + n_q) vanishes on planes, cylinders and spheres.
  void add_walls(System& system, const Rigid& pose, const glm::dvec3& pivot,
                 const std::vector<std::uint32_t>& list, double reach, bool quick) const {
    const glm::mat3 r(pose.rotation);
    const glm::vec3 t(pose.translation);
    const Finder finder = wall_finder(quick);
    for (const auto i : list) {
      const glm::vec3 p = apply(r, t, b.walls.points[i]);
      const auto hit = finder.within(p, kWallNear * thickness);
      if (!hit) continue;
      const glm::vec3 n_b = r * b.walls.normals[i];
      const glm::vec3 n_a = a.walls.normals[hit->first];
      if (glm::dot(n_a, n_b) < kWallAlike) continue;
      const glm::dvec3 n = glm::normalize(glm::dvec3(n_a + n_b));
      const double offset = glm::dot(glm::dvec3(p - a.walls.points[hit->first]), n);
      system.add(glm::dvec3(p) - pivot, n, offset, kWallWeight * tukey(offset, reach));
    }
  }

  Evidence evidence(const Rigid& pose, int most_samples, int facet_b, bool quick) const;
  void look_at_contact(const Rigid& pose, const std::vector<std::uint32_t>& from, int most_samples,
                       Evidence& e) const;
  void look_for_penetration(const Rigid& pose, int most_samples, const Finder& finder, Evidence& e) const;
  void look_at_walls(const Rigid& pose, int most_samples, bool quick, Evidence& e) const;
};

Joint::Joint(const Fragment& a, const Fragment& b) {
  const double ta = a.facets.wall_thickness;
  const double tb = b.facets.wall_thickness;
  const double thickness = ta > 0 && tb > 0 ? std::min(ta, tb) : 0.0;
  const double spacing = std::max(a.facets.samples.spacing, b.facets.samples.spacing);
  const double edge = std::max(0.2 * thickness, 1.2 * spacing);
  impl_ = std::make_unique<Impl>(std::make_shared<const Side>(side_of(a, edge)),
                                 std::make_shared<const Side>(side_of(b, edge)));
  back_ = std::make_unique<Impl>(impl_->held_b, impl_->held_a);
  const double scan = std::max(a.resolution, b.resolution);
  for (Impl* d : {impl_.get(), back_.get()}) {
    d->thickness = thickness;
    d->spacing = spacing;
    d->tolerance = std::max(thickness > 0 ? 0.05 * thickness : 0.15 * spacing, 0.3 * scan);
    d->noise = 0.05 * scan;
    d->patch = std::max({0.5 * thickness, 2.5 * spacing, 2.5 * scan});
  }
}

Joint::~Joint() = default;

double Joint::tolerance() const {
  return impl_->tolerance;
}

Rigid Joint::align(const Rigid& start, const AlignOptions& options) const {
  const Impl& d = *impl_;
  Rigid pose = start;
  auto list = d.chosen(d.b.broken, d.b.broken_of(options.facet_b), d.broken_finder(options.quick), pose,
                       2.0 * options.reach_start, options.most_samples);
  const auto walls = d.thickness > 0
                         ? d.chosen(d.b.walls, d.b.all_walls, d.wall_finder(options.quick), pose,
                                    kWallNear * d.thickness + options.reach_start, options.most_samples)
                         : std::vector<std::uint32_t>{};
  if (options.half >= 0) {
    std::erase_if(list, [&](std::uint32_t i) { return static_cast<int>(i % 2) != options.half; });
  }
  if (list.size() < 12) return pose;
  for (int k = 0; k < options.iterations; ++k) {
    const double part = options.iterations > 1 ? static_cast<double>(k) / (options.iterations - 1) : 1.0;
    const double reach = options.reach_start * std::pow(options.reach_end / options.reach_start, part);
    glm::dvec3 pivot(0.0);
    for (const auto i : list) pivot += pose(glm::dvec3(d.b.broken.points[i]));
    pivot /= static_cast<double>(list.size());
    System system;
    d.add_broken(system, pose, pivot, list, reach, options);
    if (system.weight < 6.0) break;
    if (d.thickness > 0) d.add_walls(system, pose, pivot, walls, reach, options.quick);
    // A little resistance keeps directions still that nothing holds (sliding on a plane).
    const double arm = 10.0 * d.spacing;
    for (int q = 0; q < 6; ++q) system.matrix(q, q) += 1e-3 * system.weight * (q < 3 ? arm * arm : 1.0);
    pose = moved(pose, system.matrix.ldlt().solve(system.right), pivot);
  }
  return pose;
}

namespace {

/// 1.48 times the median absolute deviation: the standard deviation of what is not outliers.
double robust_deviation(std::vector<double> values) {
  const double middle = median(values);
  for (double& v : values) v = std::abs(v - middle);
  return 1.48 * median(values);
}

/// Heights of points along `normal` above the quadric that fits them best; with more rounds, that fits most of them best.
std::vector<double> heights_above_quadric(const std::vector<glm::dvec3>& points, const glm::dvec3& normal,
                                          int rounds) {
  const glm::dmat3 frame = frame_of(normal);
  glm::dvec3 centre(0.0);
  for (const auto& p : points) centre += p / static_cast<double>(points.size());
  double size = 0.0;
  for (const auto& p : points) size = std::max(size, glm::distance(p, centre));
  std::vector<Vector6> rows;
  std::vector<double> heights;
  for (const auto& p : points) {
    const glm::dvec3 q = (p - centre) * frame / size;
    Vector6 row;
    row << 1.0, q.x, q.y, q.x * q.x, q.x * q.y, q.y * q.y;
    rows.push_back(row);
    heights.push_back(q.z);
  }
  std::vector<double> rest = heights;
  double reach = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    Matrix6 matrix = 1e-9 * static_cast<double>(points.size()) * Matrix6::Identity();
    Vector6 right = Vector6::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double weight = tukey(rest[i], reach);
      matrix += weight * rows[i] * rows[i].transpose();
      right += weight * heights[i] * rows[i];
    }
    const Vector6 fit = matrix.ldlt().solve(right);
    for (std::size_t i = 0; i < rows.size(); ++i) rest[i] = heights[i] - fit.dot(rows[i]);
    const double next = kQuadricReach * std::max(1e-12, robust_deviation(rest));
    if (std::abs(next - reach) < kQuadricSteady * next) break;
    reach = next;
  }
  for (double& height : rest) height *= size;
  return rest;
}

/// Mean of points, and the direction in which they spread most.
std::pair<glm::dvec3, glm::dvec3> middle_and_axis(const std::vector<glm::dvec3>& points) {
  glm::dvec3 centre(0.0);
  for (const auto& p : points) centre += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& p : points) {
    const Eigen::Vector3d q(p.x - centre.x, p.y - centre.y, p.z - centre.z);
    spread += q * q.transpose();
  }
  const Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  return {centre, {axis.x(), axis.y(), axis.z()}};
}

}  // namespace

Evidence Joint::Impl::evidence(const Rigid& pose, int most_samples, int facet_b, bool quick) const {
  Evidence e;
  e.tolerance = tolerance;
  look_at_contact(pose, b.broken_of(facet_b), most_samples, e);
  look_for_penetration(pose, most_samples > 0 ? std::min(most_samples, kBodySamples) : kBodySamples,
                       body_finder(quick), e);
  if (thickness > 0) look_at_walls(pose, most_samples, quick, e);
  return e;
}

Evidence Joint::evidence(const Rigid& pose, int most_samples, int facet_b, bool quick) const {
  return impl_->evidence(pose, most_samples, facet_b, quick);
}

Evidence Joint::agreed_evidence(const Rigid& pose) const {
  Evidence agreed = impl_->evidence(pose, 0, -1, false);
  const double there = strength(agreed);
  const double back = strength(back_->evidence(inverse(pose), 0, -1, false));
  if (there > 0.0) agreed.information *= std::sqrt(std::max(0.0, back) / there);
  return agreed;
}

void Joint::Impl::look_at_contact(const Rigid& pose, const std::vector<std::uint32_t>& from, int most_samples,
                                  Evidence& e) const {
  const glm::mat3 r(pose.rotation);
  const glm::vec3 t(pose.translation);
  std::vector<double> gaps;
  std::vector<double> core_gaps;
  std::vector<glm::dvec3> core;
  glm::dvec3 normal(0.0);
  double touching = 0.0;
  const std::size_t step = stride(from.size(), most_samples);
  const double share = static_cast<double>(step) * b.sample_area;
  const auto farthest = static_cast<float>(std::hypot(spacing, 4.0 * tolerance));
  for (std::size_t k = 0; k < from.size(); k += step) {
    const std::uint32_t i = from[k];
    const glm::vec3 p = apply(r, t, b.broken.points[i]);
    const auto hit = a.broken_index->nearest_within(p, farthest);
    if (!hit) continue;
    const glm::vec3 n = a.broken.normals[hit->first];
    const glm::vec3 offset = p - a.broken.points[hit->first];
    const auto gap = static_cast<double>(glm::dot(offset, n));
    const double aside = std::sqrt(std::max(0.0, static_cast<double>(glm::dot(offset, offset)) - gap * gap));
    if (aside > spacing || std::abs(gap) > 4.0 * tolerance) continue;
    if (glm::dot(n, r * b.broken.normals[i]) > kFacing) continue;
    gaps.push_back(gap);
    normal += glm::dvec3(n);
    if (!b.broken.edge[i] && !a.broken.edge[hit->first]) {
      core.emplace_back(p);
      core_gaps.push_back(gap);
    }
    if (std::abs(gap) > tolerance) continue;
    touching += 1.0;
  }
  e.contact_area = touching * share;
  e.shared_area = static_cast<double>(gaps.size()) * share;
  e.patches = e.shared_area / (patch * patch);
  e.gap_median = median(gaps);
  if (glm::length(normal) > 0) e.normal = glm::normalize(normal);
  e.core_samples = static_cast<int>(core.size());
  if (core.size() < 12 || !(glm::length(normal) > 0)) return;
  const int rounds = most_samples > 0 ? 1 : kQuadricRounds;  // few samples have no bulk to tell from the rest
  e.gap_spread = robust_deviation(core_gaps);
  e.relief = robust_deviation(heights_above_quadric(core, glm::normalize(normal), rounds));
  std::tie(e.centre, e.along) = middle_and_axis(core);
  const double patches = static_cast<double>(core.size()) * share / (patch * patch);
  e.information =
      0.5 * patches *
      std::log((e.relief * e.relief + noise * noise) / (e.gap_spread * e.gap_spread + noise * noise));
}

void Joint::Impl::look_for_penetration(const Rigid& pose, int most_samples, const Finder& finder,
                                       Evidence& e) const {
  const glm::mat3 r(pose.rotation);
  const glm::vec3 t(pose.translation);
  const std::size_t step = stride(b.body.points.size(), most_samples);
  double inside = 0.0;
  double depth = 0.0;
  for (std::size_t i = 0; i < b.body.points.size(); i += step) {
    const glm::vec3 p = apply(r, t, b.body.points[i]);
    const auto hit = finder.within(p, deepest());
    if (!hit) continue;
    const glm::vec3 offset = p - a.body.points[hit->first];
    const auto gap = static_cast<double>(glm::dot(offset, a.body.normals[hit->first]));
    if (gap > -3.0 * tolerance || -gap < 0.7 * static_cast<double>(hit->second)) continue;
    inside += 1.0;
    depth -= gap;
  }
  e.penetration_area = inside * static_cast<double>(step) * b.sample_area;
  e.penetration = inside > 0 ? depth / inside : 0.0;
}

void Joint::Impl::look_at_walls(const Rigid& pose, int most_samples, bool quick, Evidence& e) const {
  const glm::mat3 r(pose.rotation);
  const glm::vec3 t(pose.translation);
  const Finder near_broken = broken_finder(quick);
  const Finder finder = wall_finder(quick);
  double found = 0.0;
  double all = 0.0;
  const std::size_t step = stride(b.walls.points.size(), most_samples);
  for (std::size_t i = 0; i < b.walls.points.size(); i += step) {
    const glm::vec3 p = apply(r, t, b.walls.points[i]);
    if (!near_broken.within(p, kWallNear * thickness)) continue;
    all += 1.0;
    const auto hit = finder.within(p, 2.0 * kWallNear * thickness);
    if (!hit) continue;
    const glm::dvec3 n_b(r * b.walls.normals[i]);
    const glm::dvec3 n_a(a.walls.normals[hit->first]);
    if (glm::dot(n_a, n_b) < static_cast<double>(kWallAlike)) continue;
    const double offset = glm::dot(glm::dvec3(p - a.walls.points[hit->first]), glm::normalize(n_a + n_b));
    if (std::abs(offset) < kWallStep * thickness) found += 1.0;
  }
  if (all > 0) e.wall_share = found / all;
}

}  // namespace rejoin::match
