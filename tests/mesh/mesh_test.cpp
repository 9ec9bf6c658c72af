#include "mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/random.hpp"
#include "shapes.hpp"

namespace rejoin::mesh {
namespace {

using test::box;
using test::icosphere;

TEST(Mesh, BoundsAreTheOutermostCoordinates) {
  const Box found = bounds(box({2, 4, 6}, 3));
  EXPECT_EQ(found.low, glm::vec3(-1, -2, -3));
  EXPECT_EQ(found.high, glm::vec3(1, 2, 3));
}

TEST(Mesh, AreaOfABoxIsTheSumOfItsSides) {
  EXPECT_NEAR(surface_area(box({2, 3, 4}, 5)), 2 * (2 * 3 + 3 * 4 + 4 * 2), 1e-4);
}

TEST(Mesh, CentroidIgnoresHowDenselyASideIsCut) {
  // Unit square twice as dense on its left half: the mean of its vertices is off the middle, the centroid is not.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 1, 0}, {1, 1, 0}, {0.25, 0.5, 0}};
  mesh.faces = {{0, 1, 6}, {1, 4, 6}, {4, 3, 6}, {3, 0, 6}, {1, 2, 5}, {1, 5, 4}};
  EXPECT_NEAR(glm::distance(centroid(mesh), glm::dvec3(0.5, 0.5, 0)), 0, 1e-12);
}

TEST(Mesh, DiameterIsWithinOnePercentBelowTheTrueOne) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Mesh cloud;
    for (int i = 0; i < 400; ++i) {
      cloud.vertices.emplace_back(random.normal(), 0.5 * random.normal(), 3 * random.uniform());
    }
    double longest = 0;
    for (const glm::vec3& a : cloud.vertices) {
      for (const glm::vec3& b : cloud.vertices) longest = std::max<double>(longest, glm::distance(a, b));
    }
    EXPECT_LE(diameter(cloud), longest * (1 + 1e-6));
    EXPECT_GE(diameter(cloud), longest * 0.99);
  }
}

TEST(Mesh, DiameterOfABoxIsItsDiagonal) {
  EXPECT_NEAR(diameter(box({3, 4, 12}, 4)), 13, 1e-5);
}

TEST(Mesh, ResolutionIsTheMedianEdgeOfAMeshAndTheSpacingOfACloud) {
  EXPECT_NEAR(resolution(box({1, 1, 1}, 10)), 0.1,
              1e-5);  // two of three edges of each face are 0.1, one is 0.141
  Mesh cloud;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) cloud.vertices.emplace_back(0.25F * i, 0.25F * k, 0);
  }
  EXPECT_NEAR(resolution(cloud), 0.25, 1e-6);
}

TEST(Mesh, NormalsOfASpherePointAwayFromItsCentre) {
  Mesh sphere = icosphere(2, 4);
  compute_normals(sphere);
  ASSERT_EQ(sphere.normals.size(), sphere.vertices.size());
  for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
    EXPECT_GT(glm::dot(sphere.normals[i], sphere.vertices[i] / 2.0F), 0.9995F);
  }
  const std::vector<glm::vec3> normals = face_normals(sphere);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_NEAR(glm::length(normals[i]), 1, 1e-5);
    EXPECT_GT(glm::dot(normals[i], sphere.vertices[sphere.faces[i].x]), 0);
  }
}

TEST(Mesh, NormalsStayUnitLengthOnASheetDrawnFromBothSides) {
  Mesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.faces = {{0, 1, 2}, {0, 2, 1}};
  compute_normals(sheet);
  for (const glm::vec3& normal : sheet.normals) EXPECT_NEAR(std::abs(normal.z), 1, 1e-6);
}

TEST(Mesh, FaceWithoutAreaHasZeroNormal) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.faces = {{0, 1, 2}};
  EXPECT_EQ(face_normals(mesh).front(), glm::vec3(0.0F));
}

TEST(Mesh, SubmeshKeepsPlacesAndAttributesOfItsFaces) {
  Mesh mesh = box({1, 1, 1}, 2);
  mesh.origin = {7, 8, 9};
  compute_normals(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.colours.emplace_back(i, 0, 0);
  const std::vector<std::uint32_t> chosen{40, 3, 17};
  const Mesh part = submesh(mesh, chosen);
  EXPECT_EQ(part.origin, mesh.origin);
  ASSERT_EQ(part.faces.size(), chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t now = part.faces[i][k];
      const std::uint32_t before = mesh.faces[chosen[i]][k];
      EXPECT_EQ(part.vertices[now], mesh.vertices[before]);
      EXPECT_EQ(part.normals[now], mesh.normals[before]);
      EXPECT_EQ(part.colours[now], mesh.colours[before]);
    }
  }
  EXPECT_LE(part.vertices.size(), 9U);
}

}  // namespace
}  // namespace rejoin::mesh
