#include "mesh/smooth.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "core/parallel.hpp"
#include "core/rigid.hpp"
#include "mesh/area_normals.hpp"
#include "mesh/detail/mean_normals.hpp"

namespace rejoin::mesh {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kRounds = 2;                 // the first finds the normals that the second needs
constexpr int kNormalRounds = 2;           // a single normal of a noisy scan leans by 30 degrees and more
constexpr float kSameSide = 0.2F;          // cosine to the normals that are averaged,
constexpr float kSmooth = 0.7F;            // and to those of the points that a quadric is laid through
constexpr double kSpread = 0.3;            // of the radius: deviation of the weights
constexpr std::size_t kEnoughPoints = 12;  // for the six unknowns of a quadric
constexpr std::size_t kMost = 256;         // of the neighbours; even scans have 30 to 50

std::vector<glm::vec3> normals_of(const Mesh& mesh, const detail::Lists& near) {
  std::vector<glm::vec3> normals = area_normals(mesh);
  for (glm::vec3& normal : normals) {
    const float length = glm::length(normal);
    normal = length > 0.0F ? normal / length : glm::vec3(0.0F, 0.0F, 1.0F);
  }
  for (int round = 0; round < kNormalRounds; ++round)
    normals = detail::mean_normals(normals, near, kSameSide);
  return normals;
}

/// Height of the quadric that fits the neighbourhood of a point best, above the point along its normal; 0 where they are too few.
double height_above(const Mesh& mesh, const std::vector<glm::vec3>& normals,
                    const std::vector<std::uint32_t>& near, std::size_t i, double radius) {
  const glm::dmat3 frame = frame_of(glm::dvec3(normals[i]));
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  std::size_t count = 0;
  for (const auto k : near) {
    if (glm::dot(normals[k], normals[i]) < kSmooth) continue;
    const glm::dvec3 q = glm::dvec3(mesh.vertices[k] - mesh.vertices[i]) * frame / radius;
    const double weight = std::exp(-0.5 * glm::dot(q, q) / (kSpread * kSpread));
    Vector6 row;
    row << 1.0, q.x, q.y, q.x * q.x, q.x * q.y, q.y * q.y;
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    right += weight * q.z * row;
    ++count;
  }
  if (count < kEnoughPoints) return 0.0;
  matrix.diagonal().array() += 1e-6;
  return radius * matrix.ldlt().solve(right)[0];
}

/// From every vertex to the middle of the ring of faces around it.
std::vector<glm::vec3> to_ring_middles(const Mesh& mesh) {
  std::vector<glm::vec3> sums(mesh.vertices.size(), glm::vec3(0.0F));
  std::vector<float> counts(mesh.vertices.size(), 0.0F);
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3 sum = mesh.vertices[face.x] + mesh.vertices[face.y] + mesh.vertices[face.z];
    for (int k = 0; k < 3; ++k) {
      sums[face[k]] += sum - 3.0F * mesh.vertices[face[k]];
      counts[face[k]] += 2.0F;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] > 0.0F) sums[i] /= counts[i];
  }
  return sums;
}

}  // namespace

Mesh smooth(const Mesh& mesh, double radius) {
  Mesh even = mesh;
  for (int round = 0; round < kRounds; ++round) {
    const detail::Lists near = detail::neighbours_within(even.vertices, radius, kMost);
    const std::vector<glm::vec3> normals = normals_of(even, near);
    std::vector<glm::vec3> moves = to_ring_middles(even);
    parallel_for(moves.size(), 128, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const auto height = static_cast<float>(height_above(even, normals, near[i], i, radius));
        moves[i] += (height - glm::dot(moves[i], normals[i])) * normals[i];
      }
    });
    for (std::size_t i = 0; i < moves.size(); ++i) even.vertices[i] += moves[i];
  }
  return even;
}

}  // namespace rejoin::mesh
