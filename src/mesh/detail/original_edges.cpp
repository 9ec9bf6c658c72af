#include "mesh/detail/original_edges.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/angle.hpp"
#include "core/median.hpp"
#include "mesh/detail/facet_table.hpp"

namespace rejoin::mesh::detail {
namespace {

// Breaks: what the roughest or least sliding quarter of the area that may be broken has at least.
constexpr double kOfBreaks = 0.75;
constexpr double kSmooth = 0.85;  // of the roughness of breaks: lips 0.36 to 0.81, the sharper, the rougher
constexpr double kSlides = 0.4;   // of the angle of breaks between motion and surface: lips 0.08 to 0.39,
constexpr double kMostOfEdge_deg = 2.5;  // and 0.5 to 2.4; breaks with less than 0.4 of others' 3 and more
constexpr double kMostOfWalls_deg =
    5.6;  // walls with the marks of turning 2 to 4, of a tile with a rim 4 to 5.5

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Motion = Eigen::Matrix<double, 6, 1>;  // turn, shift: velocity = shift + cross(turn, place)

/// How far a surface moves out of itself by any motion: mean squares of the velocity along the normals and of all of it.
struct Moved {
  Matrix6 outwards = Matrix6::Zero();
  Matrix6 all = Matrix6::Zero();

  void add(const glm::dvec3& place, const glm::dvec3& normal) {
    const glm::dvec3 arm = glm::cross(place, normal);
    Motion out;
    out << arm.x, arm.y, arm.z, normal.x, normal.y, normal.z;
    outwards += out * out.transpose();
    Eigen::Matrix<double, 3, 6> velocity;
    velocity << 0, place.z, -place.y, 1, 0, 0,  //
        -place.z, 0, place.x, 0, 1, 0,          //
        place.y, -place.x, 0, 0, 0, 1;
    all += velocity.transpose() * velocity;
  }

  void divide_by(std::size_t count) {
    outwards /= static_cast<double>(count);
    all /= static_cast<double>(count);
  }

  double angle_deg(const Motion& motion) const {
    const double sine = motion.dot(outwards * motion) / motion.dot(all * motion);
    return std::asin(std::sqrt(std::clamp(sine, 0.0, 1.0))) / kDegree;
  }
};

/// Places about their centre, of which the mean distance is 1: turns and shifts are of one size.
class Frame {
 public:
  explicit Frame(const std::vector<glm::vec3>& points) {
    for (const glm::vec3& p : points) centre_ += glm::dvec3(p);
    centre_ /= static_cast<double>(points.size());
    for (const glm::vec3& p : points) size_ += glm::distance(glm::dvec3(p), centre_);
    size_ /= static_cast<double>(points.size());
  }
  glm::dvec3 operator()(const glm::vec3& p) const { return (glm::dvec3(p) - centre_) / size_; }

 private:
  glm::dvec3 centre_{0.0};
  double size_ = 0.0;
};

/// How a facet moves in itself.
struct Sliding {
  double facet_deg = 0;  ///< between the motion and the surface, median
  double walls_deg = 0;  ///< the same of the walls, root mean square
};

class MotionsInWalls {
 public:
  explicit MotionsInWalls(const Segmentation& s) : s_(s), frame_(s.samples.points) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < s.samples.size(); ++i) {
      if (s.surface[i] != Surface::Original) continue;
      walls_.add(frame_(s.samples.points[i]), s.normals[i]);
      ++count;
    }
    if (count > 0) walls_.divide_by(count);
  }

  /// By the motion that moves the facet and the walls together least out of themselves.
  Sliding of(const Facet& facet) const {
    Moved edge;
    for (const auto i : facet.samples) edge.add(frame_(s_.samples.points[i]), s_.normals[i]);
    edge.divide_by(facet.samples.size());
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(walls_.outwards + edge.outwards,
                                                                   walls_.all + edge.all);
    if (solver.info() != Eigen::Success) return {90.0, 90.0};
    const Motion motion = solver.eigenvectors().col(0);
    const glm::dvec3 turn(motion[0], motion[1], motion[2]);
    const glm::dvec3 shift(motion[3], motion[4], motion[5]);
    std::vector<double> sines;
    for (const auto i : facet.samples) {
      const glm::dvec3 velocity = shift + glm::cross(turn, frame_(s_.samples.points[i]));
      const double speed = std::max(glm::length(velocity), 1e-12);  // 0 on the axis of a turn
      sines.push_back(std::abs(glm::dot(velocity, glm::dvec3(s_.normals[i]))) / speed);
    }
    return {std::asin(std::min(1.0, median(sines))) / kDegree, walls_.angle_deg(motion)};
  }

 private:
  const Segmentation& s_;
  Frame frame_;
  Moved walls_;
};

/// The value that `share` of the area has at most.
double quantile_by_area(std::vector<std::pair<double, double>> value_and_area, double share) {
  std::sort(value_and_area.begin(), value_and_area.end());
  double area = 0.0;
  for (const auto& [value, part] : value_and_area) area += part;
  double below = 0.0;
  for (const auto& [value, part] : value_and_area) {
    below += part;
    if (below >= share * area) return value;
  }
  return 0.0;
}

}  // namespace

void tell_original_edges(const Segmentation& s, Cut& cut) {
  const MotionsInWalls motions(s);
  std::vector<Sliding> sliding;
  std::vector<std::pair<double, double>> rough;
  std::vector<std::pair<double, double>> moved;
  for (const Facet& facet : cut.facets) {
    if (!facet.fracture) break;  // those go first
    sliding.push_back(motions.of(facet));
    rough.emplace_back(facet.roughness, facet.area);
    moved.emplace_back(sliding.back().facet_deg, facet.area);
  }
  const double rough_break = quantile_by_area(rough, kOfBreaks);
  const double moved_break = quantile_by_area(moved, kOfBreaks);
  for (std::size_t f = 0; f < sliding.size(); ++f) {
    Facet& facet = cut.facets[f];
    facet.fracture = !(facet.roughness < kSmooth * rough_break &&
                       sliding[f].facet_deg < std::min(kSlides * moved_break, kMostOfEdge_deg) &&
                       sliding[f].walls_deg < kMostOfWalls_deg);
  }
  put_in_order(s, cut);
}

}  // namespace rejoin::mesh::detail
