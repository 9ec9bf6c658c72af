#include "mesh/detail/cloud_normals.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <queue>

#include "core/parallel.hpp"
#include "mesh/detail/local_fit.hpp"
#include "mesh/detail/outlook.hpp"
#include "mesh/point_index.hpp"
#include "mesh/surface.hpp"

namespace rejoin::mesh::detail {
namespace {

constexpr std::size_t kNeighbours = 12;
constexpr double kAgreeing = 0.95;  // share of good normals that turning along the surface leaves, or turns
constexpr double kBetter = 0.2;     // of all rays, that leave from the front and not from the back

using Lists = std::vector<std::vector<std::uint32_t>>;

/// The k nearest of every point, itself among them.
Lists nearest_of(const std::vector<glm::vec3>& points) {
  const PointIndex index(points);
  Lists lists(points.size());
  parallel_for(points.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) index.nearest(points[i], kNeighbours, lists[i]);
  });
  return lists;
}

/// Made symmetric, so that a walk reaches whole parts.
Lists mutual(const Lists& lists) {
  Lists both = lists;
  for (std::uint32_t i = 0; i < lists.size(); ++i) {
    for (const std::uint32_t k : lists[i]) both[k].push_back(i);
  }
  return both;
}

/// An undecided point, reached from a decided one.
struct Step {
  float turn;  ///< 1 - |cos| between the two normals
  std::uint32_t from;
  std::uint32_t to;
  bool operator>(const Step& other) const {
    if (turn != other.turn) return turn > other.turn;
    return to != other.to ? to > other.to : from > other.from;
  }
};

/// Turns normals to agree with each other within every part.
class Walker {
 public:
  Walker(const Lists& neighbours, std::vector<glm::vec3>& normals)
      : neighbours_(neighbours), normals_(normals), decided_(normals.size(), false) {}

  bool reached(std::uint32_t i) const { return decided_[i]; }

  /// The points of the seed's part.
  std::vector<std::uint32_t> walk(std::uint32_t seed) {
    std::vector<std::uint32_t> part;
    decide(seed, part);
    while (!steps_.empty()) {
      const Step step = steps_.top();
      steps_.pop();
      if (decided_[step.to]) continue;
      if (glm::dot(normals_[step.from], normals_[step.to]) < 0) normals_[step.to] = -normals_[step.to];
      decide(step.to, part);
    }
    return part;
  }

 private:
  void decide(std::uint32_t i, std::vector<std::uint32_t>& part) {
    decided_[i] = true;
    part.push_back(i);
    for (const std::uint32_t k : neighbours_[i]) {
      if (!decided_[k]) steps_.push({1.0F - std::abs(glm::dot(normals_[i], normals_[k])), i, k});
    }
  }

  const Lists& neighbours_;
  std::vector<glm::vec3>& normals_;
  std::vector<bool> decided_;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps_;
};

/// Directions spread evenly over the sphere (Fibonacci lattice).
std::array<glm::vec3, 64> all_round() {
  std::array<glm::vec3, 64> directions;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const float z = 1.0F - (2.0F * static_cast<float>(k) + 1.0F) / static_cast<float>(directions.size());
    const float turn = std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F)) * static_cast<float>(k);
    const float radius = std::sqrt(1.0F - z * z);
    directions[k] = {radius * std::cos(turn), radius * std::sin(turn), z};
  }
  return directions;
}

/// Whether the normals at the furthest points in all directions point inwards, taken together.
bool points_inwards(const std::vector<std::uint32_t>& part, const std::vector<glm::vec3>& points,
                    const std::vector<glm::vec3>& normals) {
  float outwards = 0;
  for (const glm::vec3& direction : all_round()) {
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
  }
  return outwards < 0;
}

void turn_along(const Lists& lists, const std::vector<glm::vec3>& points, std::vector<glm::vec3>& normals) {
  const Lists neighbours = mutual(lists);
  Walker walker(neighbours, normals);
  for (std::uint32_t seed = 0; seed < points.size(); ++seed) {
    if (walker.reached(seed)) continue;
    const std::vector<std::uint32_t> part = walker.walk(seed);
    if (!points_inwards(part, points, normals)) continue;
    for (const std::uint32_t i : part) normals[i] = -normals[i];
  }
}

/// How much more can be seen from the front of the surface through a cloud than from its back.
Outlook outlook_of(const Mesh& cloud) {
  const Mesh surface = surface_of_cloud(cloud);
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

std::vector<glm::vec3> estimate_normals(const std::vector<glm::vec3>& points) {
  const Lists lists = nearest_of(points);
  std::vector<glm::vec3> normals(points.size());
  parallel_for(points.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) normals[i] = plane_normal(points, lists[i]);
  });
  turn_along(lists, points, normals);
  return normals;
}

void turn_outwards(const std::vector<glm::vec3>& points, std::vector<glm::vec3>& normals) {
  turn_along(nearest_of(points), points, normals);
}

NormalsFound check_normals(Mesh& cloud) {
  Mesh turned = cloud;
  turn_outwards(turned.vertices, turned.normals);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.normals.size(); ++i)
    kept += glm::dot(cloud.normals[i], turned.normals[i]) > 0 ? 1 : 0;
  const double share = static_cast<double>(kept) / static_cast<double>(cloud.normals.size());
  if (std::max(share, 1 - share) < kAgreeing) {
    const Outlook before = outlook_of(cloud);
    const Outlook after = outlook_of(turned);
    if (after.front - after.back > before.front - before.back + kBetter) {
      cloud.normals = std::move(turned.normals);
      return NormalsFound::Mixed;
    }
  }
  if (swelling(cloud) >= 0 || !is_inside_out(outlook_of(cloud))) return NormalsFound::Good;
  for (glm::vec3& normal : cloud.normals) normal = -normal;
  return NormalsFound::InsideOut;
}

}  // namespace rejoin::mesh::detail
