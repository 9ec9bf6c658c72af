#include "match/align.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/tukey.hpp"
#include "match/detail/joint_sides.hpp"

namespace rejoin::match {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kWallWeight = 0.1;

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

Rigid moved(const Rigid& pose, const Vector6& step, const glm::dvec3& pivot) {
  const glm::dvec3 turn(step[0], step[1], step[2]);
  const double angle = glm::length(turn);
  const glm::dmat3 rotation = angle > 1e-12 ? axis_rotation(turn / angle, angle) : glm::dmat3(1.0);
  const glm::dvec3 shift(step[3], step[4], step[5]);
  return Rigid{rotation, pivot + shift - rotation * pivot} * pose;
}

/// Samples of B that take part, with what is known of A's nearest points from one round to the next: poses settle, and then
/// hardly any point needs to be searched.
struct Followed {
  std::vector<std::uint32_t> list;
  std::vector<mesh::PointIndex::Known> known;

  explicit Followed(std::vector<std::uint32_t> samples) : list(std::move(samples)), known(list.size()) {}
};

/// B's samples that lie within `reach` of A's can matter; every nth of them if there are more than `most`.
std::vector<std::uint32_t> chosen(const detail::Cloud& cloud, const std::vector<std::uint32_t>& from,
                                  const mesh::Box& box, const detail::Finder& finder, const Rigid& pose,
                                  double reach, int most) {
  const detail::Move move(pose);
  std::vector<std::uint32_t> list = detail::chosen_in(box, reach, cloud.points, from, move, 8 * most).list;
  std::erase_if(list, [&](std::uint32_t i) { return !finder.within(move(cloud.points[i]), reach); });
  if (most > 0 && list.size() > static_cast<std::size_t>(most)) {
    std::vector<std::uint32_t> fewer;
    fewer.reserve(static_cast<std::size_t>(most));
    const double step = static_cast<double>(list.size()) / most;
    for (int k = 0; k < most; ++k) fewer.push_back(list[static_cast<std::size_t>(k * step)]);
    list.swap(fewer);
  }
  return list;
}

/// One fragment's samples that are compared with the other's: B's with A's, or, looking back, A's with B's.
struct View {
  const detail::JointSides& sides;  ///< looking back, those that are exchanged
  Rigid pose;                       ///< B -> A
  bool back = false;
  glm::dvec3 pivot;  ///< of the motion that is looked for

  detail::Move move() const { return detail::Move(back ? inverse(pose) : pose); }

  /// A sample that lies `offset` outside the plane through its neighbour, both in the frame of the latter.
  void add(System& system, const glm::vec3& sample, const glm::vec3& neighbour, const glm::dvec3& normal,
           double offset, double weight) const {
    if (back) {
      system.add(pose(glm::dvec3(neighbour)) - pivot, pose.rotation * normal, -offset, weight);
    } else {
      system.add(glm::dvec3(sample) - pivot, normal, offset, weight);
    }
  }
};

void add_broken(System& system, const View& view, Followed& samples, double reach,
                const AlignOptions& options) {
  const detail::Cloud& a = view.sides.a().broken;
  const detail::Cloud& b = view.sides.b().broken;
  const detail::Move move = view.move();
  const detail::Finder finder = view.sides.broken_finder(options.quick);
  for (std::size_t k = 0; k < samples.list.size(); ++k) {
    const std::uint32_t i = samples.list[k];
    if (options.core_only && b.edge[i]) continue;
    const glm::vec3 p = move(b.points[i]);
    const auto hit = finder.within(p, 1.5 * reach, samples.known[k]);
    if (!hit || (options.core_only && a.edge[hit->first])) continue;
    const glm::vec3 n = a.normals[hit->first];
    if (glm::dot(n, move.direction(b.normals[i])) > detail::kFacing) continue;
    const auto offset = static_cast<double>(glm::dot(p - a.points[hit->first], n));
    view.add(system, p, a.points[hit->first], glm::dvec3(n), offset, tukey(offset, reach));
  }
}

/// Walls continue across the seam: (p - q).(n_p + n_q) vanishes on planes, cylinders and spheres.
void add_walls(System& system, const View& view, Followed& samples, double reach, bool quick) {
  const detail::Cloud& a = view.sides.a().walls;
  const detail::Cloud& b = view.sides.b().walls;
  const double near = detail::kWallNear * view.sides.lengths().thickness;
  const detail::Move move = view.move();
  const detail::Finder finder = view.sides.wall_finder(quick);
  for (std::size_t k = 0; k < samples.list.size(); ++k) {
    const std::uint32_t i = samples.list[k];
    const glm::vec3 p = move(b.points[i]);
    const auto hit = finder.within(p, near, samples.known[k]);
    if (!hit) continue;
    const glm::vec3 n_b = move.direction(b.normals[i]);
    const glm::vec3 n_a = a.normals[hit->first];
    if (glm::dot(n_a, n_b) < detail::kWallAlike) continue;
    const glm::dvec3 n = glm::normalize(glm::dvec3(n_a + n_b));
    const double offset = glm::dot(glm::dvec3(p - a.points[hit->first]), n);
    view.add(system, p, a.points[hit->first], n, offset, kWallWeight * tukey(offset, reach));
  }
}

/// Samples that take part, of one fragment.
struct Sampled {
  Followed broken;
  Followed walls;
};

/// \param pose  from the samples' fragment to the other one
Sampled sampled(const detail::JointSides& s, const Rigid& pose, int facet, const AlignOptions& options) {
  auto broken = chosen(s.b().broken, s.b().broken_of(facet), s.a().broken_box, s.broken_finder(options.quick),
                       pose, 2.0 * options.reach_start, options.most_samples);
  if (options.half >= 0) {
    std::erase_if(broken, [&](std::uint32_t i) { return static_cast<int>(i % 2) != options.half; });
  }
  const double thickness = s.lengths().thickness;
  auto walls = thickness > 0
                   ? chosen(s.b().walls, s.b().all_walls, s.a().wall_box, s.wall_finder(options.quick), pose,
                            detail::kWallNear * thickness + options.reach_start, options.most_samples)
                   : std::vector<std::uint32_t>{};
  return {Followed(std::move(broken)), Followed(std::move(walls))};
}

}  // namespace

Joint::Joint(const Fragment& a, const Fragment& b)
    : Joint(std::make_unique<const detail::JointSides>(a, b)) {}

Joint::Joint(std::unique_ptr<const detail::JointSides> sides)
    : sides_(std::move(sides)), exchanged_(sides_->exchanged()) {}

Joint Joint::worn() const {
  return Joint(sides_->worn());
}

Joint Joint::sparse() const {
  return Joint(sides_->sparse());
}

Joint::~Joint() = default;

double Joint::tolerance() const {
  return sides_->lengths().tolerance;
}

double Joint::thickness() const {
  return sides_->lengths().thickness;
}

Rigid Joint::align(const Rigid& start, const AlignOptions& options) const {
  const detail::JointSides& s = *sides_;
  const detail::JointLengths& l = s.lengths();
  Rigid pose = start;
  Sampled of_b = sampled(s, pose, options.facet_b, options);
  if (of_b.broken.list.size() < 12) return pose;
  std::optional<Sampled> of_a;
  if (options.both) of_a = sampled(*exchanged_, inverse(pose), options.facet_a, options);
  for (int k = 0; k < options.iterations; ++k) {
    const double part = options.iterations > 1 ? static_cast<double>(k) / (options.iterations - 1) : 1.0;
    const double reach = options.reach_start * std::pow(options.reach_end / options.reach_start, part);
    glm::dvec3 pivot(0.0);
    for (const auto i : of_b.broken.list) pivot += pose(glm::dvec3(s.b().broken.points[i]));
    pivot /= static_cast<double>(of_b.broken.list.size());
    System system;
    const View view{s, pose, false, pivot};
    const View back{*exchanged_, pose, true, pivot};
    add_broken(system, view, of_b.broken, reach, options);
    if (system.weight < 6.0) break;
    if (of_a) add_broken(system, back, of_a->broken, reach, options);
    if (l.thickness > 0) {
      add_walls(system, view, of_b.walls, reach, options.quick);
      if (of_a) add_walls(system, back, of_a->walls, reach, options.quick);
    }
    // A little resistance keeps directions still that nothing holds (sliding on a plane).
    const double arm = 10.0 * l.spacing;
    for (int q = 0; q < 6; ++q) system.matrix(q, q) += 1e-3 * system.weight * (q < 3 ? arm * arm : 1.0);
    pose = moved(pose, system.matrix.ldlt().solve(system.right), pivot);
  }
  return pose;
}

glm::dvec3 Joint::least_held(const Rigid& pose, double reach) const {
  const AlignOptions options{reach, reach};
  Sampled of_b = sampled(*sides_, pose, -1, options);
  System system;
  const View view{*sides_, pose, false, glm::dvec3(0.0)};
  add_broken(system, view, of_b.broken, reach, options);
  if (sides_->lengths().thickness > 0) add_walls(system, view, of_b.walls, reach, false);
  const Eigen::Matrix3d shifts = system.matrix.bottomRightCorner<3, 3>();
  const Eigen::Vector3d least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(shifts).eigenvectors().col(0);
  return {least.x(), least.y(), least.z()};
}

}  // namespace rejoin::match
