#include "match/detail/shape.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/median.hpp"
#include "core/rigid.hpp"
#include "core/tukey.hpp"
#include "mesh/neighbours.hpp"

namespace rejoin::match::detail {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kSteady = 0.02;  // share by which the deviation may still change in the end
constexpr double kReach = 7.0;    // robust deviations beyond which a height does not bend the quadric

}  // namespace

double robust_deviation(std::vector<double> values) {
  const double middle = median(values);
  for (double& v : values) v = std::abs(v - middle);
  return 1.48 * median(values);
}

std::vector<double> heights_above_quadric(const std::vector<glm::dvec3>& points, const glm::dvec3& normal,
                                          int rounds) {
  const glm::dmat3 frame = frame_of(normal);
  const glm::dvec3 centre = middle(points);
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
    const double next = kReach * std::max(1e-12, robust_deviation(rest));
    if (std::abs(next - reach) < kSteady * next) break;
    reach = next;
  }
  for (double& height : rest) height *= size;
  return rest;
}

std::vector<double> variances_by_scale(const std::vector<glm::dvec3>& points,
                                       const std::vector<double>& values, std::span<const double> radii) {
  const std::vector<glm::vec3> places(points.begin(), points.end());
  std::vector<double> variances;
  std::vector<std::uint32_t> near;
  for (const double radius : radii) {
    const mesh::Neighbours neighbours(places, static_cast<float>(radius));
    std::vector<double> left = values;
    for (std::size_t i = 0; i < places.size(); ++i) {
      neighbours.of(places[i], near);
      double sum = 0.0;
      for (const auto j : near) sum += values[j];
      left[i] -= sum / static_cast<double>(near.size());
    }
    variances.push_back(std::pow(robust_deviation(std::move(left)), 2.0));
  }
  variances.push_back(std::pow(robust_deviation(values), 2.0));
  return variances;
}

glm::dvec3 middle(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum(0.0);
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

}  // namespace rejoin::match::detail
