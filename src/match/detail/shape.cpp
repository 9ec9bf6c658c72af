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

std::array<std::vector<double>, 2> variances_by_scale(const std::vector<glm::dvec3>& points,
                                                      const std::array<std::span<const double>, 2>& values,
                                                      std::span<const double> radii) {
  const std::vector<glm::vec3> places(points.begin(), points.end());
  std::array<std::vector<double>, 2> variances;
  std::array<std::vector<double>, 2> left{std::vector<double>(places.size()),
                                          std::vector<double>(places.size())};
  for (const double radius : radii) {
    const mesh::Neighbours neighbours(places, static_cast<float>(radius));
    for (std::size_t i = 0; i < places.size(); ++i) {
      std::array<double, 2> sums{};
      double count = 0.0;
      neighbours.each(places[i], [&](std::uint32_t j) {
        sums[0] += values[0][j];
        sums[1] += values[1][j];
        count += 1.0;
      });
      for (const int v : {0, 1}) left[v][i] = values[v][i] - sums[v] / count;
    }
    for (const int v : {0, 1}) variances[v].push_back(std::pow(robust_deviation(left[v]), 2.0));
  }
  for (const int v : {0, 1})
    variances[v].push_back(std::pow(robust_deviation({values[v].begin(), values[v].end()}), 2.0));
  return variances;
}

glm::dvec3 middle(const std::vector<glm::dvec3>& points) {
  glm::dvec3 sum(0.0);
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

}  // namespace rejoin::match::detail
