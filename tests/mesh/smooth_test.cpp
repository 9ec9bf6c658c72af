#include "mesh/smooth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "facet_shapes.hpp"
#include "mesh/detail/weld.hpp"
#include "mesh/noise.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

constexpr float kBallRadius = 50;

/// As a scanner sees it that puts every point off by a deviation along every axis.
Mesh scanned(Mesh mesh, double deviation) {
  Random random(3);
  for (glm::vec3& v : mesh.vertices)
    v += glm::vec3(glm::dvec3(random.normal(), random.normal(), random.normal()) * deviation);
  return mesh;
}

Mesh smoothed(const Mesh& scan) {
  return smooth(scan, kSmoothRadius * resolution(scan));
}

/// Square of the given side at z = 0 whose points are 1 apart, seen from above, with a height.
template <class Height>
Mesh sheet(int side, Height height) {
  Mesh mesh;
  const auto row = static_cast<std::uint32_t>(side + 1);
  for (std::uint32_t p = 0; p < row * row; ++p) {
    const glm::vec2 at(p % row, p / row);
    mesh.vertices.emplace_back(at, height(at.x, at.y));
    if (p % row + 1 == row || p / row + 1 == row) continue;
    mesh.faces.emplace_back(p, p + 1, p + row + 1);
    mesh.faces.emplace_back(p, p + row + 1, p + row);
  }
  return mesh;
}

bool is_inside(const glm::vec3& p, float side) {
  return std::min(p.x, p.y) > 5.0F && std::max(p.x, p.y) < side - 5.0F;
}

TEST(Smooth, LeavesTheShareOfTheNoiseThatIsTold) {
  const Mesh sphere = test::icosphere(kBallRadius, 5);
  for (const double share : {0.1, 0.2, 0.3}) {
    const Mesh scan = scanned(sphere, share * resolution(sphere));
    double sum = 0.0;
    for (const glm::vec3& v : smoothed(scan).vertices)
      sum += std::pow(static_cast<double>(glm::length(v) - kBallRadius), 2.0);
    const double left = std::sqrt(sum / static_cast<double>(scan.vertices.size()));
    EXPECT_NEAR(left / noise(scan), kNoiseLeft, 0.05) << share;
  }
}

TEST(Smooth, LeavesShapeThatIsWiderThanNoise) {
  // Waves of 12 spacings, as high as those of a break.
  const auto wave = [](float x, float /*y*/) {
    return std::sin(x * static_cast<float>(std::numbers::pi) / 6.0F);
  };
  const Mesh waves = smoothed(sheet(60, wave));
  for (const glm::vec3& v : waves.vertices) {
    if (!is_inside(v, 60)) continue;
    EXPECT_NEAR(v.z, wave(v.x, v.y), 0.05);
  }
}

TEST(Smooth, LaysFoldedFacesFlat) {
  const auto folded = [](const Mesh& mesh) {
    const std::vector<glm::vec3> normals = face_normals(mesh);
    int count = 0;
    for (std::size_t f = 0; f < normals.size(); ++f)
      count += is_inside(mesh.vertices[mesh.faces[f].x], 60) && normals[f].z < 0.5F ? 1 : 0;
    return count;
  };
  const Mesh scan = scanned(sheet(60, test::flat), 0.3);
  EXPECT_GT(folded(scan), 500);
  EXPECT_LT(folded(smoothed(scan)), 5);
}

TEST(Smooth, LeavesEdgesAndTheFarSideOfAWall) {
  Mesh plate = test::box({60, 40, 3}, 50, test::flat);
  detail::weld(plate);
  const Mesh even = smoothed(scanned(plate, 0.2));
  for (const glm::vec3& v : even.vertices) {
    const glm::vec3 half(30, 20, 1.5);
    const glm::vec3 off = glm::abs(v - half) - half;
    if (std::max(off.x, off.y) < -3.0F) {
      EXPECT_LT(std::abs(off.z), 0.4F);  // of the scan up to four deviations, 0.8
    } else {
      EXPECT_LT(std::abs(std::max({off.x, off.y, off.z})), 0.9F);  // edges are rounded by less than a spacing
    }
  }
}

}  // namespace
}  // namespace rejoin::mesh
