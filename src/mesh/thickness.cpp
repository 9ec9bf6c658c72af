#include "mesh/thickness.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/median.hpp"
#include "core/parallel.hpp"
#include "core/rigid.hpp"
#include "mesh/ray_scene.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kSquare = 0.8F;  // rays that leave within 37 degrees of the normal count for the thickness
constexpr double kBinsPerOctave = 12.0;  // 6 % wide bins: finer than the walls of a thrown pot vary
constexpr double kThinnest = 1.0 / 4096.0;
constexpr double kMostOfSize = 0.12;    // of a thin piece
constexpr double kMostOfSherd = 0.2;    // of one whose walls run parallel nearly everywhere, however thick
constexpr double kMostOfSmooth = 0.3;   // of one whose walls are smoother than its breaks
constexpr float kParallel = 0.95F;      // within 18 degrees
constexpr double kLeastParallel = 0.2;  // of a thin piece's surface: cracks of a solid lean on each other
constexpr double kLeastSmooth = 0.15;   // of the surface of a sherd with smooth walls is parallel
constexpr double kSlab = 0.7;           // of the squares of its normals lie along one direction
constexpr float kSmoothWall = 0.5F;     // roughness of such walls, of that of the rest, at most
constexpr double kRougherWall = 0.75;   // quantile: one wall may be carved and the other sawn
constexpr double kNearLow = 0.6;        // of the thickness
constexpr double kNearHigh = 1.6;
constexpr double kEvenLow = 0.8;  // the same of walls that run parallel
constexpr double kEvenHigh = 1.25;
constexpr std::size_t kAskedAcross = 16;  // every so manyth sample
constexpr int kWays = 8;                  // across the piece, half a turn in all
constexpr double kRodAcross =
    2.3;  // thicknesses; sherds are wider, and tubes from place to place along their wall
constexpr double kRodLong = 4.0;  // times as long as wide: small sherds may be as narrow

/// Share of the normals' squares along the direction, or its opposite, in which most of them point: 1 of a slab, 0.5 of a rod.
double share_along_one(const std::vector<bool>& chosen, const std::vector<glm::vec3>& normals) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d n(normals[i].x, normals[i].y, normals[i].z);
    if (chosen[i]) spread += n * n.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(2) / std::max(spread.trace(), 1e-300);
}

/// Roughness between that of what has a parallel surface behind it and that of the rest; 0: the former is not smooth against the latter.
float between(const std::vector<bool>& parallel, const std::vector<float>& roughness) {
  std::vector<float> walls;
  std::vector<float> rest;
  for (std::size_t i = 0; i < roughness.size(); ++i) (parallel[i] ? walls : rest).push_back(roughness[i]);
  const float smooth = median(walls);
  const float rough = median(rest);
  if (smooth >= kSmoothWall * rough) return 0.0F;
  const float rougher = quantile(walls, kRougherWall);
  return std::max(std::sqrt(rougher * rough),
                  kSmoothWall * kSmoothWall * rough);  // of planes the first is nought
}

/// The shortest chord of the body at right angles to a normal.
/// \param middle  of the body, under the sample that has the normal
float shortest_across(const RayScene& scene, const glm::vec3& middle, const glm::vec3& normal) {
  const glm::dmat3 frame = frame_of(glm::dvec3(normal));
  float shortest = std::numeric_limits<float>::infinity();
  for (int way = 0; way < kWays; ++way) {
    const double angle = std::numbers::pi * way / kWays;
    const glm::vec3 direction(frame * glm::dvec3(std::cos(angle), std::sin(angle), 0.0));
    float chord = 0.0F;
    for (const glm::vec3& along : {direction, -direction}) {
      const auto hit = scene.first_hit(middle, along, 0.0F, std::numeric_limits<float>::max());
      chord += hit ? hit->distance : std::numeric_limits<float>::infinity();
    }
    shortest = std::min(shortest, chord);
  }
  return shortest;
}

/// Whether the piece is a rod, as a rib or a rod of wood is: hardly wider than thick, and long.
bool is_rod(const InwardRays& rays, double thickness, double size) {
  std::vector<float> across;
  for (std::size_t i = 0; i < rays.across.size(); ++i) {
    const double ratio = static_cast<double>(rays.length[i * kAskedAcross]) / thickness;
    if (rays.square[i * kAskedAcross] > kSquare && ratio > kNearLow && ratio < kNearHigh)
      across.push_back(rays.across[i]);
  }
  if (across.empty()) return false;
  const auto width = static_cast<double>(median(across));
  return width < kRodAcross * thickness && size > kRodLong * width;
}

}  // namespace

InwardRays cast_inwards(const Mesh& mesh, const Samples& samples, const std::vector<glm::vec3>& normals) {
  const RayScene scene(mesh);
  const auto face_normal = face_normals(mesh);
  InwardRays rays;
  rays.length.assign(samples.size(), std::numeric_limits<float>::infinity());
  rays.square.assign(samples.size(), 0.0F);
  rays.across.assign((samples.size() + kAskedAcross - 1) / kAskedAcross,
                     std::numeric_limits<float>::infinity());
  const auto skip = static_cast<float>(0.05 * samples.spacing);
  parallel_for(samples.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const glm::vec3 inwards = -normals[i];
      float from = skip;
      // A ray may first graze the roughness it starts from: go on until it leaves the body.
      for (int tries = 0; tries < 4; ++tries) {
        const auto hit = scene.first_hit(samples.points[i], inwards, from, std::numeric_limits<float>::max());
        if (!hit) break;
        const float square = glm::dot(face_normal[hit->face], inwards);
        if (square > 0.0F) {
          rays.length[i] = hit->distance;
          rays.square[i] = square;
          break;
        }
        from = hit->distance + skip;
      }
      if (i % kAskedAcross == 0 && rays.square[i] > kSquare)
        rays.across[i / kAskedAcross] =
            shortest_across(scene, samples.points[i] + 0.5F * rays.length[i] * inwards, normals[i]);
    }
  });
  return rays;
}

Walls find_walls(const InwardRays& rays, const std::vector<glm::vec3>& normals,
                 const std::vector<float>& roughness, double size) {
  const auto bins = static_cast<std::size_t>(std::log2(1.0 / kThinnest) * kBinsPerOctave) + 1;
  std::vector<double> histogram(bins, 0.0);
  for (std::size_t i = 0; i < rays.length.size(); ++i) {
    if (!(rays.square[i] > kSquare)) continue;
    const double ratio = static_cast<double>(rays.length[i]) / size;
    if (ratio <= kThinnest || ratio >= 1.0) continue;
    ++histogram[static_cast<std::size_t>(std::log2(ratio / kThinnest) * kBinsPerOctave)];
  }
  double most = 0.0;
  std::size_t mode = 0;
  for (std::size_t i = 1; i + 1 < bins; ++i) {
    const double smooth = histogram[i - 1] + 2.0 * histogram[i] + histogram[i + 1];
    if (smooth <= most) continue;
    most = smooth;
    mode = i;
  }
  const double guess = size * kThinnest * std::exp2((static_cast<double>(mode) + 0.5) / kBinsPerOctave);
  std::vector<float> near;
  std::size_t parallel = 0;
  std::size_t parallel_anyhow = 0;
  std::vector<bool> is_parallel(rays.length.size(), false);
  for (std::size_t i = 0; i < rays.length.size(); ++i) {
    const double ratio = static_cast<double>(rays.length[i]) / guess;
    if (rays.square[i] > kSquare && ratio > kNearLow && ratio < kNearHigh) near.push_back(rays.length[i]);
    if (rays.square[i] <= kParallel) continue;
    const bool even = ratio > kEvenLow && ratio < kEvenHigh;
    const bool anyhow = static_cast<double>(rays.length[i]) < kEvenHigh * kMostOfSherd * size;
    parallel += even ? 1 : 0;
    parallel_anyhow += anyhow ? 1 : 0;
    is_parallel[i] = even || anyhow;
  }
  const bool thin = guess <= kMostOfSize * size && 3 * near.size() >= rays.length.size() &&
                    static_cast<double>(parallel) >= kLeastParallel * static_cast<double>(rays.length.size());
  const bool sherd = guess <= kMostOfSherd * size && 2 * parallel_anyhow >= rays.length.size();
  Walls walls;
  if (near.empty()) return walls;  // thinner than any bin
  if (!thin && !sherd) {
    const auto share =
        static_cast<double>(std::ranges::count(is_parallel, true)) / static_cast<double>(is_parallel.size());
    if (guess <= kMostOfSize * size || guess > kMostOfSmooth * size || share < kLeastSmooth ||
        share_along_one(is_parallel, normals) < kSlab)
      return walls;
    walls.roughest = between(is_parallel, roughness);
    if (walls.roughest == 0.0F) return walls;
  }
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  const auto thickness = static_cast<double>(*middle);
  if (is_rod(rays, thickness, size)) return {};
  walls.thickness = thickness;
  return walls;
}

}  // namespace rejoin::mesh
