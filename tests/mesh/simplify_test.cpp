#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/surface.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

/// Distance from a point to the nearest place of a triangle.
double distance_to(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const auto inside = [&](const glm::dvec3& u, const glm::dvec3& v) {
    return glm::dot(n, glm::cross(v - u, p - u)) >= 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(glm::dot(p - a, n)) / glm::length(n);
  const auto to_edge = [&](const glm::dvec3& u, const glm::dvec3& v) {
    const double t = std::clamp(glm::dot(p - u, v - u) / glm::dot(v - u, v - u), 0.0, 1.0);
    return glm::distance(p, u + t * (v - u));
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

double furthest_from(const std::vector<glm::vec3>& points, const Mesh& mesh) {
  double worst = 0;
  for (const glm::vec3& point : points) {
    double nearest = 1e300;
    for (const glm::uvec3& f : mesh.faces) {
      nearest =
          std::min(nearest, distance_to(point, mesh.vertices[f.x], mesh.vertices[f.y], mesh.vertices[f.z]));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(Simplify, KeepsAMeshThatFitsTheBudget) {
  const Mesh sphere = test::icosphere(1, 2);
  const Mesh same = simplify(sphere, 320);
  EXPECT_EQ(same.faces, sphere.faces);
  EXPECT_EQ(same.vertices, sphere.vertices);
}

TEST(Simplify, StaysCloseToASphereAndWithinTheBudget) {
  Mesh sphere = test::icosphere(1, 5);
  sphere.origin = {1, 2, 3};
  compute_normals(sphere);
  const Mesh coarse = simplify(sphere, 2000);
  EXPECT_EQ(coarse.origin, sphere.origin);
  EXPECT_EQ(coarse.normals.size(), coarse.vertices.size());
  EXPECT_LE(coarse.faces.size(), 2000U);
  EXPECT_GE(coarse.faces.size(), 1800U);
  // Half a pixel of a 128 x 128 map of it (2.6 / 128 / 2).
  EXPECT_LE(furthest_from(sphere.vertices, coarse), 0.01);
  EXPECT_EQ(test::count_edges(coarse).open, 0U);
  EXPECT_NEAR(test::volume(coarse), test::volume(sphere), 0.02 * test::volume(sphere));
}

TEST(Simplify, KeepsSharpEdgesAndThinWalls) {
  const Mesh plate = test::box({10, 10, 0.3F}, 40);
  const Mesh coarse = simplify(plate, 500);
  EXPECT_LE(coarse.faces.size(), 500U);
  EXPECT_LE(furthest_from(plate.vertices, coarse), 0.02);
  EXPECT_NEAR(test::volume(coarse), 30, 0.3);
}

TEST(Simplify, ReachesTheBudgetWhereTopologyStopsTheQuadricSimplifier) {
  // Thousands of boxes that are not connected cannot lose faces one by one without vanishing.
  Mesh dust;
  const Mesh grain = test::box({1, 1, 1}, 1);
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 12; ++k) {
      for (int l = 0; l < 12; ++l) {
        const auto first = static_cast<std::uint32_t>(dust.vertices.size());
        for (const glm::vec3& vertex : grain.vertices)
          dust.vertices.push_back(vertex + 2.0F * glm::vec3(i, k, l));
        for (const glm::uvec3& face : grain.faces) dust.faces.push_back(face + first);
      }
    }
  }
  const Mesh coarse = simplify(dust, 2000);
  EXPECT_GT(coarse.faces.size(), 0U);
  EXPECT_LE(coarse.faces.size(), 2400U);
}

}  // namespace
}  // namespace rejoin::mesh
