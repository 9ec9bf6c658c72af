#include "outline/contact.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/cyclic.hpp"
#include "core/smooth.hpp"
#include "outline/signal.hpp"

namespace rejoin::outline {
namespace {

// Borders touch when they face each other to within 60 degrees.
constexpr double kFacing = 0.5;
// Directions are compared over this many steps: a border's own changes of direction against those between both.
constexpr std::size_t kLag = 6;
// Steps that one independent direction takes: the smoothing's width.
constexpr double kStepsADirection = 5.0;
// Squared error of a direction below which nothing more can be learnt, radians squared.
constexpr double kFloor = 0.006;
// Points in a row that touch nothing end a contact.
constexpr long kMisses = 3;
// The field's reach, in steps.
constexpr double kReach = 4.0;

/// One side of a contact: sums over a's border.
struct Side {
  double count = 0.0;
  double pairs = 0.0;        // of samples a lag apart
  double changes = 0.0;      // squared change of a's own direction over the lag, of all pairs
  double differences = 0.0;  // squared difference of direction to the other border
  double intruding = 0.0;
  double squares = 0.0;
};

Side measure_side(const Silhouette& a, const Silhouette& b, const Planar& motion, double tolerance) {
  Side side;
  const Motion a_to_b(motion);
  const glm::dvec2 low = b.low - tolerance;
  const glm::dvec2 high = b.high + tolerance;
  const std::size_t count = a.points.size();
  std::vector<char> touching(count, 0);
  for (std::size_t i = 0, next = 1; i < count; i = next) {
    const glm::dvec2 p = a_to_b(a.points[i]);
    next = i + b.field.stride(p, a.step);
    if (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y) continue;
    const double depth = b.field(p);
    if (depth > tolerance) side.intruding += 1.0;
    if (std::abs(depth) > tolerance) continue;
    const glm::dvec2 inward = b.field.gradient(p);
    const double slope = glm::length(inward);
    if (slope <= 0.0) continue;
    const double facing = glm::dot(a_to_b.direction(a.normals[i]), inward) / slope;
    // Side by side two borders face each other; two scans of one piece on one spot have borders that look the same way.
    if (facing < -kFacing) side.intruding += 1.0;
    if (facing < kFacing) continue;
    side.count += 1.0;
    side.squares += depth * depth;
    side.differences += 2.0 * (1.0 - facing);
    touching[i] = 1;
  }
  // Corners at the ends of the contact turn away from the other piece and say nothing: both samples must touch.
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + kLag) % count;
    if (touching[i] == 0 || touching[next] == 0) continue;
    side.pairs += 1.0;
    side.changes += 2.0 * (1.0 - glm::dot(a.normals[i], a.normals[next]));
  }
  return side;
}

double information(const Side& side) {
  if (side.pairs <= 0.0) return 0.0;
  const double changes = side.changes / side.pairs + kFloor;
  const double differences = side.differences / side.count + kFloor;
  return std::max(0.0, 0.5 * side.count / kStepsADirection * std::log(changes / differences));
}

}  // namespace

Silhouette::Silhouette(const Outline& outline, double wanted_step, double smoothing)
    : step(0.0), low(0.0), high(0.0), field(outline.points, wanted_step, kReach * wanted_step) {
  points = smooth(resample_by(outline.points, wanted_step), smoothing);
  step = perimeter(outline.points) / static_cast<double>(points.size());
  low = high = points[0];
  normals.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 along =
        points[(i + 1) % points.size()] - points[(i + points.size() - 1) % points.size()];
    const double length = glm::length(along);
    normals.push_back(length > 0.0 ? glm::dvec2(along.y, -along.x) / length : glm::dvec2(0.0));
    low = glm::min(low, points[i]);
    high = glm::max(high, points[i]);
  }
}

PointRun grown_run(const Silhouette& a, const Silhouette& b, const Planar& a_to_b, double tolerance,
                   PointRun run) {
  const Motion motion(a_to_b);
  const auto count = static_cast<long>(a.points.size());
  const auto touches = [&](long i) {
    const std::size_t at = wrapped(i, a.points.size());
    const glm::dvec2 p = motion(a.points[at]);
    if (std::abs(b.field(p)) > tolerance) return false;
    const glm::dvec2 inward = b.field.gradient(p);
    return glm::dot(motion.direction(a.normals[at]), inward) >= kFacing * glm::length(inward);
  };
  for (const long way : {-1L, 1L}) {
    long& end = way < 0 ? run.first : run.last;
    long misses = 0;
    for (long at = end + way; misses < kMisses && std::max(run.last, at) - std::min(run.first, at) < count;
         at += way) {
      misses = touches(at) ? 0 : misses + 1;
      if (misses == 0) end = at;
    }
  }
  return run;
}

Contact measure_contact(const Silhouette& a, const Silhouette& b, const Planar& b_to_a, double tolerance) {
  const Side ours = measure_side(a, b, inverse(b_to_a), tolerance);
  const Side theirs = measure_side(b, a, b_to_a, tolerance);
  Contact contact;
  contact.length = 0.5 * (ours.count * a.step + theirs.count * b.step);
  contact.information = 0.5 * (information(ours) + information(theirs));
  contact.intrusion = std::max(ours.intruding * a.step, theirs.intruding * b.step);
  const double count = ours.count + theirs.count;
  contact.rms = count > 0.0 ? std::sqrt((ours.squares + theirs.squares) / count) : 0.0;
  return contact;
}

Planar settle(const Silhouette& a, const Silhouette& b, const Planar& b_to_a, double tolerance,
              int iterations) {
  Planar pose = b_to_a;
  const glm::dvec2 centre = 0.5 * (b.low + b.high);
  const double arm = 0.25 * (b.high.x - b.low.x + b.high.y - b.low.y);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    // Unknown: a turn about B's centre (times the arm, so that all three are lengths) and a shift, in A's frame.
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const Motion motion(pose);
    const glm::dvec2 pivot = motion(centre);
    for (std::size_t i = 0, next = 1; i < b.points.size(); i = next) {
      const glm::dvec2 p = motion(b.points[i]);
      next = i + a.field.stride(p, b.step);
      const double depth = a.field(p);
      if (std::abs(depth) > tolerance) continue;
      const glm::dvec2 inward = a.field.gradient(p);
      const double slope = glm::length(inward);
      if (slope <= 0.0 || glm::dot(motion.direction(b.normals[i]), inward) < kFacing * slope) continue;
      const glm::dvec2 off = (p - pivot) / arm;
      const Eigen::Vector3d row(inward.y * off.x - inward.x * off.y, inward.x, inward.y);
      normal += row * row.transpose();
      right -= row * depth;
    }
    if (normal.trace() <= 0.0) break;
    // Damped, so that nothing slides along a straight border.
    normal += 1e-3 * normal.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    const double turn = step[0] / arm;
    const Planar rotation{turn, {}, false};
    const glm::dvec2 moved_pivot = pivot + glm::dvec2(step[1], step[2]);
    pose = Planar{turn, moved_pivot - rotation.direction(pivot), false} * pose;
  }
  return pose;
}

}  // namespace rejoin::outline
