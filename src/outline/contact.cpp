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
// No more samples count than carry the changes, by their fourth moment, so that one corner does not make long straight borders tell.
// 3 would be all of a normal distribution's; torn paper has few bends, and 5 loses joins of it.
constexpr double kCarrying = 8.0;
// Points in a row that touch nothing end a contact.
constexpr long kMisses = 3;
// The field's reach, in steps.
constexpr double kReach = 4.0;
// Shorter borders of holes have no shape, steps.
constexpr double kShortestHole = 16.0;

/// One side of a contact: sums over a's borders.
struct Side {
  double length = 0.0;  // file units
  double count = 0.0;
  double pairs = 0.0;        // of samples a lag apart
  double changes = 0.0;      // squared change of a's own direction over the lag, of all pairs
  double fourth = 0.0;       // of the changes' squares, summed up
  double turns = 0.0;        // squared sine of the change over a lag, of neighbouring lags
  double going_on = 0.0;     // product of these neighbours' sines
  double differences = 0.0;  // squared difference of direction to the other border
  double intruding = 0.0;    // file units
  double squares = 0.0;
};

void add_ring(const Silhouette& a, const Ring& ring, const Silhouette& b, const Motion& a_to_b,
              double tolerance, Side& side) {
  const glm::dvec2 low = b.low - tolerance;
  const glm::dvec2 high = b.high + tolerance;
  const std::size_t count = ring.end - ring.begin;
  std::vector<char> touching(count, 0);
  double touched = 0.0;
  double intruding = 0.0;
  visit_near(a, ring, a_to_b, b.field, [&](std::size_t i, const glm::dvec2& p) {
    if (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y) return;
    const double depth = b.field(p);
    if (depth > tolerance) intruding += 1.0;
    if (std::abs(depth) > tolerance) return;
    const glm::dvec2 inward = b.field.gradient(p);
    const double slope = glm::length(inward);
    if (slope <= 0.0) return;
    const double facing = glm::dot(a_to_b.direction(a.normals[i]), inward) / slope;
    // Side by side two borders face each other; two scans of one piece on one spot have borders that look the same way.
    if (facing < -kFacing) intruding += 1.0;
    if (facing < kFacing) return;
    touched += 1.0;
    side.squares += depth * depth;
    side.differences += 2.0 * (1.0 - facing);
    touching[i - ring.begin] = 1;
  });
  side.count += touched;
  side.length += touched * ring.step;
  side.intruding += intruding * ring.step;
  // Corners at the ends of the contact turn away from the other piece and say nothing: both samples must touch.
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + kLag) % count;
    if (touching[i] == 0 || touching[next] == 0) continue;
    side.pairs += 1.0;
    const double change = 2.0 * (1.0 - glm::dot(a.normals[ring.begin + i], a.normals[ring.begin + next]));
    side.changes += change;
    side.fourth += change * change;
    const std::size_t beyond = (next + kLag) % count;
    if (touching[beyond] == 0) continue;
    const double turn = cross(a.normals[ring.begin + i], a.normals[ring.begin + next]);
    const double after = cross(a.normals[ring.begin + next], a.normals[ring.begin + beyond]);
    side.turns += 0.5 * (turn * turn + after * after);
    side.going_on += turn * after;
  }
}

Side measure_side(const Silhouette& a, const Silhouette& b, const Planar& a_to_b, double tolerance) {
  Side side;
  const Motion motion(a_to_b);
  for (const Ring& ring : a.rings) add_ring(a, ring, b, motion, tolerance, side);
  return side;
}

/// A smooth border goes on turning as it did: of its samples few tell something new, by the turning's autocorrelation.
double independent_share(const Side& side) {
  const double correlation = side.turns > 0.0 ? std::clamp(side.going_on / side.turns, 0.0, 1.0) : 0.0;
  return (1.0 - correlation) / (1.0 + correlation);
}

double information(const Side& side) {
  if (side.pairs <= 0.0) return 0.0;
  const double changes = side.changes / side.pairs + kFloor;
  const double differences = side.differences / side.count + kFloor;
  const double carrying =
      side.fourth > 0.0 ? std::min(1.0, kCarrying * side.changes * side.changes / side.fourth / side.pairs)
                        : 1.0;
  return std::max(0.0, 0.5 * carrying * independent_share(side) * side.count / kStepsADirection *
                           std::log(changes / differences));
}

/// The outer border and the holes that have a shape at the scale.
Outline with_long_holes(const Outline& outline, double least) {
  Outline result;
  result.points = outline.points;
  for (const std::size_t number : long_borders(outline, least))
    if (number > 0) result.holes.push_back(border_of(outline, number));
  return result;
}

/// Of a closed border that has the piece on its left: a hole's point into the hole.
std::vector<glm::dvec2> outward_normals(const std::vector<glm::dvec2>& border) {
  const std::size_t count = border.size();
  std::vector<glm::dvec2> normals;
  normals.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 along = border[(i + 1) % count] - border[(i + count - 1) % count];
    const double length = glm::length(along);
    normals.push_back(length > 0.0 ? glm::dvec2(along.y, -along.x) / length : glm::dvec2(0.0));
  }
  return normals;
}

}  // namespace

Silhouette::Silhouette(const Outline& outline, double wanted_step, double smoothing)
    : step(0.0),
      low(0.0),
      high(0.0),
      field(with_long_holes(outline, kShortestHole * wanted_step), wanted_step, kReach * wanted_step) {
  for (const std::size_t number : long_borders(outline, kShortestHole * wanted_step)) {
    const std::vector<glm::dvec2>& border = border_of(outline, number);
    const std::vector<glm::dvec2> even = smooth(resample_by(border, wanted_step), smoothing);
    const std::vector<glm::dvec2> outward = outward_normals(even);
    rings.push_back(
        {points.size(), points.size() + even.size(), perimeter(border) / static_cast<double>(even.size())});
    points.insert(points.end(), even.begin(), even.end());
    normals.insert(normals.end(), outward.begin(), outward.end());
  }
  step = rings[0].step;
  low = high = points[0];
  for (std::size_t i = 0; i < rings[0].end; ++i) {
    low = glm::min(low, points[i]);
    high = glm::max(high, points[i]);
  }
}

PointRun grown_run(const Silhouette& a, const Silhouette& b, const Planar& a_to_b, double tolerance,
                   PointRun run) {
  const Motion motion(a_to_b);
  const auto count = static_cast<long>(a.rings[0].end);
  const auto touches = [&](long i) {
    const std::size_t at = wrapped(i, a.rings[0].end);
    const glm::dvec2 p = motion(a.points[at]);
    if (std::abs(b.field(p)) > tolerance) return false;
    const glm::dvec2 inward = b.field.gradient(p);
    return glm::dot(motion.direction(a.normals[at]), inward) >= kFacing * glm::length(inward);
  };
  const auto begins_contact = [&](long at, long way) {
    for (long k = 0; k < kMisses; ++k)
      if (!touches(at - way * k)) return false;
    return true;
  };
  const PointRun whole = run;
  for (const long way : {-1L, 1L}) {
    long& end = way < 0 ? run.first : run.last;
    while (run.first < run.last && !begins_contact(end, way)) end -= way;
  }
  if (run.first >= run.last) run = whole;
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
  contact.length = 0.5 * (ours.length + theirs.length);
  contact.information = 0.5 * (information(ours) + information(theirs));
  contact.intrusion = std::max(ours.intruding, theirs.intruding);
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
    const auto add = [&](std::size_t i, const glm::dvec2& p) {
      const double depth = a.field(p);
      if (std::abs(depth) > tolerance) return;
      const glm::dvec2 inward = a.field.gradient(p);
      const double slope = glm::length(inward);
      if (slope <= 0.0 || glm::dot(motion.direction(b.normals[i]), inward) < kFacing * slope) return;
      const glm::dvec2 off = (p - pivot) / arm;
      const Eigen::Vector3d row(inward.y * off.x - inward.x * off.y, inward.x, inward.y);
      normal += row * row.transpose();
      right -= row * depth;
    };
    for (const Ring& ring : b.rings) visit_near(b, ring, motion, a.field, add);
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
