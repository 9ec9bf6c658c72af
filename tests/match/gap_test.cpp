#include "match/gap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

namespace rejoin::match {
namespace {

/// A square of side 2 about the origin, n x n cells, at height z; seen from above if `up`.
mesh::Mesh plane(int n, float z, bool up) {
  mesh::Mesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(2.0F * i / n - 1, 2.0F * j / n - 1, z);
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::uint32_t at = j * (n + 1) + i;
      const std::uint32_t over = at + n + 1;
      for (glm::uvec3 face : {glm::uvec3(at, at + 1, over), glm::uvec3(at + 1, over + 1, over)}) {
        if (!up) std::swap(face.y, face.z);
        mesh.faces.push_back(face);
      }
    }
  }
  return mesh;
}

mesh::Mesh sphere(float radius, int rings) {
  mesh::Mesh mesh;
  const float pi = std::numbers::pi_v<float>;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < 2 * rings; ++i) {
      const float tilt = pi * j / rings;
      const float turn = pi * i / rings;
      mesh.vertices.emplace_back(radius * std::sin(tilt) * std::cos(turn),
                                 radius * std::sin(tilt) * std::sin(turn), radius * std::cos(tilt));
    }
  }
  const std::uint32_t around = 2 * rings;
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rings); ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = j * around + i;
      const std::uint32_t b = j * around + (i + 1) % around;
      mesh.faces.emplace_back(a, a + around, b);
      mesh.faces.emplace_back(b, a + around, b + around);
    }
  }
  return mesh;
}

/// Cube of side 2 about the origin, with shared corners.
mesh::Mesh cube() {
  mesh::Mesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back((k & 1) * 2 - 1, (k >> 1 & 1) * 2 - 1, (k >> 2) * 2 - 1);
  mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(Gap, ParallelPlanesKeepTheirDistanceAndSign) {
  const mesh::Mesh below = plane(8, 0.0F, true);
  const mesh::Mesh above = plane(5, 0.0F, false);
  for (const double shift : {0.25, -0.125}) {
    for (const float gap : signed_gaps(below, above, {glm::dmat3(1.0), {0, 0, shift}}, 0.5)) {
      EXPECT_NEAR(gap, shift, 1e-6);
    }
  }
}

TEST(Gap, IsNanBeyondTheDistanceAskedFor) {
  const Rigid pose{glm::dmat3(1.0), {0, 0, 0.25}};
  for (const float gap : signed_gaps(plane(8, 0, true), plane(5, 0, false), pose, 0.2))
    EXPECT_TRUE(std::isnan(gap));
}

TEST(Gap, ConcentricSpheresAreTheirRadiiApart) {
  const mesh::Mesh inner = sphere(0.9F, 24);
  const mesh::Mesh outer = sphere(1.0F, 96);
  // A chord of 96 rings sags by at most 1 - cos(pi / 96) * cos(pi / 192) = 0.0007 below the sphere.
  for (const float gap : signed_gaps(inner, outer, Rigid{}, 0.5)) EXPECT_NEAR(gap, -0.1, 1e-3);
  for (const float gap : signed_gaps(outer, sphere(0.9F, 96), Rigid{}, 0.5)) EXPECT_NEAR(gap, 0.1, 1e-3);
}

TEST(Gap, SignHoldsNextToSharpEdgesAndCorners) {
  const mesh::Mesh box = cube();
  const GapField field(box);
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    const glm::vec3 p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
    const glm::vec3 beyond = glm::max(glm::abs(p) - 1.0F, glm::vec3(0.0F));
    const float largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const float truth = largest > 1 ? glm::length(beyond) : largest - 1;
    const auto sample = field.at(p, 10.0F);
    ASSERT_TRUE(sample.has_value());
    EXPECT_NEAR(sample->gap, truth, 2e-6) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(Gap, ASliverThatIsFoldedOverDoesNotTurnTheSign) {
  mesh::Mesh block = cube();
  block.vertices.emplace_back(1.0F, 1.0001F, 0.0F);  // 8, a little beyond the edge from 3 to 7
  block.faces[10] = {1, 3, 8};                       // of {1, 3, 5} and {3, 7, 5}: the first goes with it
  block.faces[11] = {1, 8, 5};
  block.faces.insert(block.faces.end(), {{8, 7, 5}, {3, 7, 8}});  // the last looks inwards
  const GapField field(block);
  Random random(11);
  for (int k = 0; k < 500; ++k) {
    const glm::vec3 outside(random.uniform(1.001, 3), random.uniform(1.001, 3), random.uniform(-0.9, 0.9));
    EXPECT_GT(field.at(outside, 10.0F)->gap, 0.0F) << outside.x << ' ' << outside.y << ' ' << outside.z;
    const glm::vec3 inside(random.uniform(0.5, 0.99), random.uniform(0.5, 0.99), random.uniform(-0.9, 0.9));
    EXPECT_LT(field.at(inside, 10.0F)->gap, 0.0F) << inside.x << ' ' << inside.y << ' ' << inside.z;
  }
}

TEST(Gap, DoesNotChangeWhenBothScansLieFarAway) {
  mesh::Mesh a = plane(8, 0, true);
  mesh::Mesh b = plane(5, 0, false);
  a.origin = {4.5e6, -2.0e6, 310.0};
  b.origin = {-7.0e5, 1.0e6, 12.0};
  Rigid pose{axis_rotation(glm::normalize(glm::dvec3(1, 2, 3)), 0.0),
             a.origin - b.origin + glm::dvec3(0, 0, 0.25)};
  for (const float gap : signed_gaps(a, b, pose, 0.5)) EXPECT_NEAR(gap, 0.25, 1e-6);
}

TEST(Gap, FollowsThePoseOfB) {
  const mesh::Mesh a = plane(8, 0.0F, true);
  const mesh::Mesh b = plane(8, 0.0F, true);  // must be turned over to face a
  const Rigid pose{axis_rotation({0, 1, 0}, std::numbers::pi), {0, 0, 0.1}};
  const Gaps result = gaps(a, GapField(b), pose, 0.5);
  for (std::size_t i = 0; i < result.gap.size(); ++i) {
    EXPECT_NEAR(result.gap[i], 0.1, 1e-6);
    EXPECT_NEAR(result.facing[i], 1.0, 1e-6);
  }
}

TEST(Gap, IsTheSameOnOneAndOnFourThreads) {
  const mesh::Mesh a = sphere(1.0F, 60);
  const mesh::Mesh b = sphere(1.02F, 50);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return signed_gaps(a, b, {axis_rotation({0, 0, 1}, 0.1), {0.01, 0, 0}}, 0.1);
  };
  EXPECT_EQ(run(1), run(4));
}

TEST(Gap, NoFacesIsAnInputError) {
  mesh::Mesh cloud = plane(2, 0, true);
  cloud.faces.clear();
  EXPECT_THROW(signed_gaps(plane(2, 0, true), cloud, Rigid{}, 1.0), InputError);
}

TEST(Contact, OfFacingPlanesIsTheirOverlap) {
  const mesh::Mesh a = plane(40, 0, true);
  const mesh::Mesh b = plane(3, 0, false);
  const Rigid pose{glm::dmat3(1.0), {1.0, 0, 0.05}};
  const Contact contact = contact_of(a, gaps(a, GapField(b), pose, 0.06));
  // Half of a lies under b; the reach beyond b's border, sqrt(0.06^2 - 0.05^2) = 0.033, is less than a cell
  // of 0.05.
  EXPECT_NEAR(contact.area, 2.0, 0.06);
  EXPECT_NEAR(contact.gap_median, 0.05, 1e-6);
  EXPECT_EQ(contact.penetration, 0);
  EXPECT_NEAR(contact.normal.z, 1, 1e-6);
  EXPECT_NEAR(contact.centre.x, 0.5, 0.03);
}

TEST(Contact, PenetrationIsTheMeanDepthOfOverlap) {
  const mesh::Mesh a = plane(10, 0, true);
  const Contact contact =
      contact_of(a, gaps(a, GapField(plane(3, 0, false)), {glm::dmat3(1.0), {0, 0, -0.03}}, 0.1));
  EXPECT_NEAR(contact.penetration, 0.03, 1e-6);
  EXPECT_NEAR(contact.area, 4.0, 1e-4);
}

TEST(Contact, NoiseOfTheScanMakesNoHoles) {
  mesh::Mesh a = plane(60, 0, true);
  Random random(3);
  const double cell = 2.0 / 60;
  for (glm::vec3& vertex : a.vertices) vertex.z += static_cast<float>(random.uniform(-2 * cell, 2 * cell));
  const Contact contact =
      contact_of(a, gaps(a, GapField(plane(3, 0, false)), {glm::dmat3(1.0), {0, 0, 0.01}}, 0.2));
  EXPECT_GT(contact.area, 0.99 * mesh::surface_area(a));  // by one ring of faces alone it is 0.95
}

TEST(Contact, SurfacesThatLookTheSameWayDoNotTouch) {
  const mesh::Mesh a = plane(10, 0, true);
  const Contact contact =
      contact_of(a, gaps(a, GapField(plane(3, 0, true)), {glm::dmat3(1.0), {0, 0, 0.03}}, 0.1));
  EXPECT_EQ(contact.area, 0);
  EXPECT_EQ(contact.normal, glm::dvec3(0.0));
}

}  // namespace
}  // namespace rejoin::match
