#include "outline/detail/pose_fit.hpp"

#include <Eigen/Core>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

namespace rejoin::outline::detail {
namespace {

constexpr double kAcross = 0.1;

/// Residuals of a turn about B's centre and a shift, in Eigen's form.
class Residuals {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Residuals(const std::vector<PointPair>& pairs, const Planar& start) : pairs_(pairs), start_(start) {
    for (const PointPair& pair : pairs) centre_ += pair.on_b / static_cast<double>(pairs.size());
  }

  int inputs() const { return 3; }
  int values() const { return 2 * static_cast<int>(pairs_.size()); }

  /// The motion x = (turn beyond the start, shift beyond the start).
  Planar pose(const Eigen::VectorXd& x) const {
    Planar result = start_;
    result.angle_rad += x[0];
    result.translation = start_(centre_) + glm::dvec2(x[1], x[2]) - result.direction(centre_);
    return result;
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    const Planar moved = pose(x);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      store(pairs_[i], moved(pairs_[i].on_b) - pairs_[i].on_a,
            [&](int k, double value) { residuals[2 * static_cast<Eigen::Index>(i) + k] = value; });
    return 0;
  }

  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) const {
    const Planar moved = pose(x);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const glm::dvec2 arm = moved.direction(pairs_[i].on_b - centre_);
      const glm::dvec2 columns[3] = {{-arm.y, arm.x}, {1.0, 0.0}, {0.0, 1.0}};
      for (int column = 0; column < 3; ++column)
        store(pairs_[i], columns[column],
              [&](int k, double value) { jacobian(2 * static_cast<Eigen::Index>(i) + k, column) = value; });
    }
    return 0;
  }

 private:
  /// The two components of a difference, weighed.
  template <typename Put>
  static void store(const PointPair& pair, const glm::dvec2& difference, const Put& put) {
    if (pair.normal == glm::dvec2(0.0)) {
      put(0, difference.x);
      put(1, difference.y);
    } else {
      put(0, glm::dot(difference, pair.normal));
      put(1, kAcross * (difference.y * pair.normal.x - difference.x * pair.normal.y));
    }
  }

  const std::vector<PointPair>& pairs_;
  Planar start_;
  glm::dvec2 centre_{0.0};
};

}  // namespace

Planar fit_pose(const std::vector<PointPair>& pairs, const Planar& start) {
  Residuals residuals(pairs, start);
  Eigen::LevenbergMarquardt<Residuals> solver(residuals);
  solver.parameters.maxfev = 60;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  solver.minimize(x);
  Planar pose = residuals.pose(x);
  pose.angle_rad = std::remainder(pose.angle_rad, 2.0 * M_PI);
  return pose;
}

Planar pose_of_three(const std::vector<PointPair>& pairs, bool flipped) {
  const PointPair& first = pairs.front();
  const PointPair& middle = pairs[pairs.size() / 2];
  const PointPair& last = pairs.back();
  const Planar turned_over{0.0, {}, flipped};
  const glm::dvec2 along_a = last.on_a - first.on_a;
  const glm::dvec2 along_b = turned_over.direction(last.on_b - first.on_b);
  Planar pose{std::atan2(along_a.y, along_a.x) - std::atan2(along_b.y, along_b.x), {}, flipped};
  pose.translation = (first.on_a + middle.on_a + last.on_a) / 3.0 -
                     pose.direction((first.on_b + middle.on_b + last.on_b) / 3.0);
  return pose;
}

}  // namespace rejoin::outline::detail
