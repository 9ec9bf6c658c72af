#include "assembly/spread.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/parallel.hpp"
#include "core/tukey.hpp"

namespace rejoin::assembly {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kRounds = 14;
constexpr double kReachStart = 16.0;  // touching distances, of worn breaks
constexpr double kReachEnd = 3.0;     // of fresh ones, to which the worn places of worn ones are not drawn
constexpr double kReachMet = 2.0;     // all along, of two that nobody searched for
constexpr std::size_t kMostPoints = 500;  // a pair and way
constexpr double kPull = 0.03;            // weight of the pair's own pose against a contact point's
constexpr double kLeastPoints = 8.0;      // a contact of fewer says nothing

/// What a pair adds to the normal equations; rows of a, then of b.
struct Block {
  Matrix6 aa = Matrix6::Zero();
  Matrix6 ab = Matrix6::Zero();
  Matrix6 bb = Matrix6::Zero();
  Vector6 a = Vector6::Zero();
  Vector6 b = Vector6::Zero();

  /// A residual whose derivative by b's motion is `row`, by a's motion -row.
  void add(const Vector6& row, double residual, double weight) {
    const Matrix6 square = weight * row * row.transpose();
    const Vector6 right = -weight * residual * row;
    aa += square;
    bb += square;
    ab -= square;
    a -= right;
    b += right;
  }
};

Vector6 row_of(const glm::dvec3& arm, const glm::dvec3& direction) {
  const glm::dvec3 turn = glm::cross(arm, direction);
  Vector6 row;
  row << turn.x, turn.y, turn.z, direction.x, direction.y, direction.z;
  return row;
}

/// A motion is a turn about `centre` (near the group) and a shift.
class Rounds {
 public:
  Rounds(const std::vector<Piece>& pieces, const std::vector<Touching>& contacts, const glm::dvec3& centre)
      : pieces_(pieces), contacts_(contacts), centre_(centre) {
    for (const Touching& contact : contacts) {
      for (const std::size_t piece : {contact.a, contact.b})
        unit_area_ = std::max(unit_area_, pieces[piece].fragment().facets.sample_area);
    }
  }

  std::vector<Block> blocks(const std::vector<Rigid>& poses, double share) const {
    std::vector<Block> result(contacts_.size());
    parallel_for(contacts_.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) result[k] = block(contacts_[k], poses, share);
    });
    return result;
  }

 private:
  /// What a sample of a piece counts for.
  double point_of(const Piece& piece) const { return piece.fragment().facets.sample_area / unit_area_; }

  Block block(const Touching& contact, const std::vector<Rigid>& poses, double share) const {
    const Piece& a = pieces_[contact.a];
    const Piece& b = pieces_[contact.b];
    const double touching = match::contact_tolerance(a.fragment(), b.fragment(), match::Breaks::Fresh);
    const double start =
        kReachStart * match::contact_tolerance(a.fragment(), b.fragment(), match::Breaks::Worn);
    const double reach = contact.known == Known::Met ? kReachMet * touching
                                                     : start * std::pow(kReachEnd * touching / start, share);
    const Rigid b_to_a = inverse(poses[contact.a]) * poses[contact.b];
    Block result;
    double weight = 0.0;
    for (const Facing& f : facing_points(a, b, b_to_a, 1.5 * reach, kMostPoints)) {
      weight += add_contact(result, poses[contact.a](f.on_a), poses[contact.b](f.on_b),
                            poses[contact.a].rotation * f.normal_a, reach, f.area_of_b / unit_area_);
    }
    for (const Facing& f : facing_points(b, a, inverse(b_to_a), 1.5 * reach, kMostPoints)) {
      // Here the roles are swapped: the plane is b's, the point a's.
      weight += add_contact(result, poses[contact.a](f.on_b), poses[contact.b](f.on_a),
                            poses[contact.b].rotation * f.normal_a, reach, f.area_of_b / unit_area_);
    }
    if (contact.known == Known::Searched)
      add_pull(result, contact, poses, std::max(weight, kLeastPoints * std::min(point_of(a), point_of(b))));
    return result;
  }

  /// (on b - on a) . normal -> 0
  double add_contact(Block& block, const glm::dvec3& on_a, const glm::dvec3& on_b, const glm::dvec3& normal,
                     double reach, double share) const {
    const double residual = glm::dot(on_b - on_a, normal);
    const double weight = share * tukey(residual, reach);
    if (weight > 0.0) block.add(row_of(on_b - centre_, normal), residual, weight);
    return weight;
  }

  /// Eight corners about b's centre towards where the pair's own pose has them.
  void add_pull(Block& block, const Touching& contact, const std::vector<Rigid>& poses, double weight) const {
    const Piece& b = pieces_[contact.b];
    const Rigid wanted = poses[contact.a] * contact.pose;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 side((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                            (corner & 4) != 0 ? 1 : -1);
      const glm::dvec3 point = b.centre() + 0.5 * b.radius() * side;
      const glm::dvec3 now = poses[contact.b](point);
      const glm::dvec3 off = now - wanted(point);
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 direction(0.0);
        direction[axis] = 1.0;
        block.add(row_of(now - centre_, direction), off[axis], kPull * weight / 8.0);
      }
    }
  }

  const std::vector<Piece>& pieces_;
  const std::vector<Touching>& contacts_;
  glm::dvec3 centre_;
  double unit_area_ = 0;  ///< a contact counts by its area; in this unit a point has about one
};

Rigid moved(const Rigid& pose, const Vector6& step, const glm::dvec3& centre) {
  const glm::dvec3 turn(step[0], step[1], step[2]);
  const double angle = glm::length(turn);
  const glm::dmat3 rotation = angle > 1e-15 ? axis_rotation(turn / angle, angle) : glm::dmat3(1.0);
  return Rigid{rotation, centre + glm::dvec3(step[3], step[4], step[5]) - rotation * centre} * pose;
}

/// Solves for the motions of the free members; number[k] = unknown of piece k, -1 = it stays.
Eigen::VectorXd solve(const std::vector<Block>& blocks, const std::vector<Touching>& contacts,
                      const std::map<std::size_t, int>& number, int unknowns, double arm) {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(unknowns));
  const auto put = [&](int row, int column, const Matrix6& m) {
    if (row < 0 || column < 0) return;
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 6; ++k) entries.emplace_back(6 * row + i, 6 * column + k, m(i, k));
  };
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const int a = number.at(contacts[c].a);
    const int b = number.at(contacts[c].b);
    put(a, a, blocks[c].aa);
    put(b, b, blocks[c].bb);
    put(a, b, blocks[c].ab);
    put(b, a, blocks[c].ab.transpose());
    if (a >= 0) right.segment<6>(6 * static_cast<Eigen::Index>(a)) += blocks[c].a;
    if (b >= 0) right.segment<6>(6 * static_cast<Eigen::Index>(b)) += blocks[c].b;
  }
  Matrix6 still = Matrix6::Zero();  // a little resistance for what nothing holds
  still.diagonal() << arm * arm, arm * arm, arm * arm, 1.0, 1.0, 1.0;
  for (int k = 0; k < unknowns; ++k) put(k, k, 1e-3 * still);
  Eigen::SparseMatrix<double> matrix(right.size(), right.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
}

}  // namespace

void spread_error(const std::vector<Piece>& pieces, const std::vector<std::size_t>& members,
                  const std::vector<Touching>& contacts, const std::vector<std::size_t>& fixed,
                  std::vector<Rigid>& poses) {
  std::map<std::size_t, int> number;
  glm::dvec3 centre(0.0);
  double arm = 0.0;
  int unknowns = 0;
  for (const std::size_t k : members) {
    const bool stays =
        fixed.empty() ? k == members.front() : std::find(fixed.begin(), fixed.end(), k) != fixed.end();
    number[k] = stays ? -1 : unknowns++;
    centre += poses[k](pieces[k].centre()) / static_cast<double>(members.size());
    arm = std::max(arm, pieces[k].radius());
  }
  if (unknowns == 0 || contacts.empty()) return;
  const Rounds rounds(pieces, contacts, centre);
  for (int round = 0; round < kRounds; ++round) {
    const auto blocks = rounds.blocks(poses, static_cast<double>(round) / (kRounds - 1));
    const Eigen::VectorXd step = solve(blocks, contacts, number, unknowns, arm);
    if (!step.allFinite()) return;
    for (const std::size_t k : members) {
      const Eigen::Index at = 6 * static_cast<Eigen::Index>(number[k]);
      if (at >= 0) poses[k] = moved(poses[k], step.segment<6>(at), centre);
    }
  }
}

}  // namespace rejoin::assembly
