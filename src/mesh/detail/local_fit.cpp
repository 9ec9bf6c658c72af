#include "mesh/detail/local_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rejoin::mesh::detail {

PlaneFit fit_plane(const std::vector<glm::vec3>& points, std::span<const std::uint32_t> chosen) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : chosen) mean += Eigen::Vector3d(points[i].x, points[i].y, points[i].z);
  mean /= static_cast<double>(chosen.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : chosen) {
    const Eigen::Vector3d d = Eigen::Vector3d(points[i].x, points[i].y, points[i].z) - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Eigen::Vector3d least = solver.eigenvectors().col(0);
  const double sum = solver.eigenvalues().sum();
  return {glm::normalize(glm::vec3(least.x(), least.y(), least.z())),
          sum > 0.0 ? static_cast<float>(std::max(0.0, solver.eigenvalues()[0]) / sum) : 0.0F};
}

glm::vec3 plane_normal(const std::vector<glm::vec3>& points, std::span<const std::uint32_t> chosen) {
  return fit_plane(points, chosen).normal;
}

double quadric_residual(std::span<const glm::dvec3> points) {
  constexpr int kUnknowns = 6;
  constexpr std::size_t kLeast = 12;  // two for each
  if (points.size() < kLeast) return 0.0;
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal = Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Eigen::Matrix<double, kUnknowns, 1> right = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  double squares = 0.0;
  for (const glm::dvec3& p : points) {
    Eigen::Matrix<double, kUnknowns, 1> row;
    row << 1.0, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y;
    for (int c = 0; c < kUnknowns; ++c) {
      for (int r = c; r < kUnknowns; ++r)
        normal(r, c) += row[r] * row[c];  // LDL^T reads nothing above the diagonal
    }
    right += row * p.z;
    squares += p.z * p.z;
  }
  const Eigen::Matrix<double, kUnknowns, 1> fit = normal.ldlt().solve(right);
  return std::sqrt(std::max(0.0, squares - fit.dot(right)) /
                   (static_cast<double>(points.size()) - kUnknowns));
}

}  // namespace rejoin::mesh::detail
