// Surfaces through clouds whose true surface is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "mesh/surface.hpp"
#include "shapes.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::mesh {
namespace {

double longest_edge(const Mesh& mesh) {
  double longest = 0;
  for (const glm::uvec3& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      longest = std::max<double>(longest, glm::distance(mesh.vertices[f[k]], mesh.vertices[f[(k + 1) % 3]]));
    }
  }
  return longest;
}

std::size_t unused_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const glm::uvec3& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) used[face[k]] = true;
  }
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

/// What every surface through a cloud must keep.
void expect_sound(const Mesh& surface, const Mesh& cloud) {
  EXPECT_EQ(surface.vertices, cloud.vertices);
  EXPECT_EQ(surface.normals, cloud.normals);
  const test::Edges edges = test::count_edges(surface);
  EXPECT_EQ(edges.non_manifold, 0U);
  EXPECT_EQ(edges.against, 0U);
  const std::vector<glm::vec3> normals = face_normals(surface);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const glm::uvec3& f = surface.faces[i];
    EXPECT_GT(glm::dot(normals[i], cloud.normals[f.x] + cloud.normals[f.y] + cloud.normals[f.z]), 0);
  }
}

TEST(SurfaceOfCloud, ClosesASphere) {
  for (const float scale : {1e-3F, 1.0F, 1e5F}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(testing::Message() << "scale " << scale << " seed " << seed);
      const Mesh cloud = test::sphere_cloud(scale, 0.06F * scale, seed);
      const Mesh surface = surface_of_cloud(cloud);
      expect_sound(surface, cloud);
      EXPECT_EQ(test::count_edges(surface).open, 0U);
      EXPECT_EQ(unused_vertices(surface), 0U);
      // Chords lie inside the sphere: edges of about 0.08 cost 0.08^2 / 4 of the area at most.
      EXPECT_NEAR(surface_area(surface) / (4 * std::numbers::pi * scale * scale), 1, 0.005);
    }
  }
}

TEST(SurfaceOfCloud, CoversABoxAcrossItsSharpEdges) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const glm::vec3 size(2, 1.5F, 1);
    const Mesh cloud = test::box_cloud(size, 0.04F, seed);
    const Mesh surface = surface_of_cloud(cloud);
    expect_sound(surface, cloud);
    const test::Edges edges = test::count_edges(surface);
    EXPECT_LE(edges.open, edges.total / 200);
    // Points rarely lie on the edges, so triangles cut them off: 12 edges of 18 length, each up to 0.04 * (2 - sqrt 2).
    const double area = 2 * (2 * 1.5 + 1.5 * 1 + 2 * 1);
    EXPECT_NEAR(surface_area(surface), area, 0.03 * area);
    EXPECT_NEAR(test::volume(surface), 3, 0.05);
  }
}

TEST(SurfaceOfCloud, NeverConnectsTheSidesOfAThinWall) {
  // A plate two spacings thick: every triangle must lie on one side or pass round the rim.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const float wall = 0.1F;
    const Mesh cloud = test::box_cloud({3, 2, wall}, 0.05F, seed);
    const Mesh surface = surface_of_cloud(cloud);
    expect_sound(surface, cloud);
    std::size_t through = 0;
    for (const glm::uvec3& f : surface.faces) {
      float low = 1;
      float high = -1;
      bool inner = true;
      for (int k = 0; k < 3; ++k) {
        const glm::vec3& p = surface.vertices[f[k]];
        low = std::min(low, p.z);
        high = std::max(high, p.z);
        inner = inner && std::abs(p.x) < 1.4F && std::abs(p.y) < 0.9F;
      }
      if (inner && high - low > 0.01F) ++through;
    }
    EXPECT_EQ(through, 0U);
    EXPECT_LT(longest_edge(surface), 0.25);
    // The rim's two edges of 10 are cut off by up to 0.05 * (2 - sqrt 2) each.
    EXPECT_NEAR(surface_area(surface), 2 * (6 + 0.2 + 0.3), 0.5);
  }
}

TEST(SurfaceOfCloud, FollowsASharpWedge) {
  // Two planes that meet at 60 degrees, as chipped rims do: normals differ by 120.
  Random random(3);
  Mesh cloud;
  const float slope = std::numbers::pi_v<float> / 6;
  for (const float side : {-1.0F, 1.0F}) {
    for (int i = 0; i < 40; ++i) {
      for (int k = 0; k < 40; ++k) {
        const float along =
            0.05F * (static_cast<float>(i) + 0.5F + 0.3F * static_cast<float>(random.uniform(-1, 1)));
        const float y = 0.05F * (static_cast<float>(k) + 0.3F * static_cast<float>(random.uniform(-1, 1)));
        cloud.vertices.emplace_back(-along * std::cos(slope), y, side * along * std::sin(slope));
        cloud.normals.emplace_back(std::sin(slope), 0, side * std::cos(slope));
      }
    }
  }
  const Mesh surface = surface_of_cloud(cloud);
  expect_sound(surface, cloud);
  // Two squares of 2 x 2; the cut-off tip is half a spacing wide.
  EXPECT_GT(surface_area(surface), 0.94 * 8);
  EXPECT_LT(surface_area(surface), 1.01 * 8);
}

double smooth_maximum(double a, double b) {
  constexpr double kReach = 4.0;
  const double near = std::max(0.0, kReach - std::abs(a - b)) / kReach;
  return std::max(a, b) + 0.25 * kReach * near * near;
}

/// Share of normals that point away from the true ones.
double share_turned(const std::vector<glm::vec3>& normals, const std::vector<glm::vec3>& truth) {
  std::size_t turned = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) turned += glm::dot(normals[i], truth[i]) < 0 ? 1 : 0;
  return static_cast<double>(turned) / static_cast<double>(truth.size());
}

/// A chip, one of whose edges is sharp (25 degrees) and all others are rounded.  Planes through neighbours of the sharp edge lie between its
/// sides, so that normals turn little from one to the other there: the way around the other edges is the right one.
TEST(EstimateNormals, BothSidesOfASharpEdgePointOutwards) {
  const double slope = std::tan(25.0 * kDegree);
  const shatter::Grid grid{.centre = {20, 0, 8}, .size = 64, .spacing = 0.4};
  const Mesh chip = shatter::surface_nets(
      [&](const glm::dvec3& p) {
        const double sharp = std::max(-p.z, (p.z - slope * p.x) / std::hypot(1.0, slope));
        return smooth_maximum(sharp, smooth_maximum(p.x - 40.0, std::abs(p.y) - 22.0));
      },
      grid, Context{});
  std::vector<glm::vec3> outwards(chip.vertices.size(), glm::vec3(0.0F));
  for (const glm::uvec3& f : chip.faces) {
    const glm::vec3 normal =
        glm::cross(chip.vertices[f.y] - chip.vertices[f.x], chip.vertices[f.z] - chip.vertices[f.x]);
    for (int k = 0; k < 3; ++k) outwards[f[k]] += normal;
  }
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    Mesh cloud = test::spread(1.2F, [&](glm::vec3& point, glm::vec3& normal) {
      const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(chip.vertices.size()));
      point = chip.vertices[k];
      normal = outwards[k];
    });
    const std::vector<glm::vec3> truth = cloud.normals;
    cloud.normals.clear();
    estimate_normals(cloud);
    EXPECT_LT(share_turned(cloud.normals, truth), 0.05) << "seed " << seed;
  }
}

/// Points anywhere on a plate of 100 x 80, with truth as normals.
Mesh scattered_plate(float wall, std::size_t points, std::uint64_t seed) {
  Random random(seed);
  const glm::vec3 half(50, 40, wall / 2);
  const glm::vec3 areas = 1.0F / half;
  Mesh cloud;
  while (cloud.vertices.size() < points) {
    double at = random.uniform(0, areas.x + areas.y + areas.z);
    int axis = 0;
    while (axis < 2 && at >= areas[axis]) at -= areas[axis++];
    const float side = random.uniform() < 0.5 ? -1.0F : 1.0F;
    glm::vec3 point;
    for (int k = 0; k < 3; ++k) point[k] = half[k] * static_cast<float>(random.uniform(-1, 1));
    point[axis] = side * half[axis];
    glm::vec3 normal(0.0F);
    normal[axis] = side;
    cloud.vertices.push_back(point);
    cloud.normals.push_back(normal);
  }
  return cloud;
}

/// The wall is as thick as two steps between its points: the edges have hardly a point that lies in a plane with its neighbours, and
/// some pairs of neighbours there say that one side is to be turned against the other.
TEST(EstimateNormals, BothSidesOfAThinPlatePointOutwards) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Mesh cloud = scattered_plate(4, 4000, seed);
    const std::vector<glm::vec3> truth = cloud.normals;
    cloud.normals.clear();
    estimate_normals(cloud);
    EXPECT_LT(share_turned(cloud.normals, truth), 0.05) << "seed " << seed;
  }
}

TEST(SurfaceOfCloud, LeavesWideHolesOpenAndClosesSmallOnes) {
  const Mesh full = test::sphere_cloud(1, 0.04F, 9);
  const auto without_cap = [&](float angle) {
    Mesh cloud;
    for (std::size_t i = 0; i < full.vertices.size(); ++i) {
      if (full.vertices[i].z > std::cos(angle)) continue;
      cloud.vertices.push_back(full.vertices[i]);
      cloud.normals.push_back(full.normals[i]);
    }
    return surface_of_cloud(cloud);
  };
  EXPECT_EQ(test::count_edges(without_cap(0.05F)).open, 0U);  // 2.5 spacings wide
  EXPECT_GT(test::count_edges(without_cap(0.4F)).open, 15U);  // 20 spacings wide
}

TEST(SurfaceOfCloud, NoiseMakesNoHolesAndNoFolds) {
  Mesh cloud = test::sphere_cloud(1, 0.05F, 10);
  Random random(11);
  for (std::size_t i = 0; i < cloud.vertices.size(); ++i) {
    cloud.vertices[i] *= 1 + 0.005F * static_cast<float>(random.normal());  // a tenth of the spacing
    cloud.normals[i] = glm::normalize(cloud.normals[i] +
                                      0.15F * glm::vec3(random.normal(), random.normal(), random.normal()));
  }
  const Mesh surface = surface_of_cloud(cloud);
  expect_sound(surface, cloud);
  const test::Edges edges = test::count_edges(surface);
  EXPECT_LE(edges.open, edges.total / 500);
}

TEST(SurfaceOfCloud, AGridOfEqualDistancesIsCoveredOnce) {
  // Four points on every circle: each star may choose another diagonal.
  Mesh cloud;
  for (int i = 0; i < 30; ++i) {
    for (int k = 0; k < 30; ++k) {
      cloud.vertices.emplace_back(i, k, 0);
      cloud.normals.emplace_back(0, 0, 1);
    }
  }
  const Mesh surface = surface_of_cloud(cloud);
  expect_sound(surface, cloud);
  EXPECT_EQ(surface.faces.size(), 2U * 29 * 29);
  EXPECT_NEAR(surface_area(surface), 29 * 29, 1e-3);
}

TEST(SurfaceOfCloud, OneThreadGivesTheSameFacesAsMany) {
  const Mesh cloud = test::box_cloud({1, 1, 0.5F}, 0.02F, 12);
  const Mesh many = surface_of_cloud(cloud);
  const ThreadLimit limit(1);
  EXPECT_EQ(surface_of_cloud(cloud).faces, many.faces);
}

TEST(SurfaceOfCloud, TinyCloudsGiveWhatTheyCan) {
  Mesh cloud;
  cloud.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  cloud.normals.assign(3, {0, 0, 1});
  EXPECT_EQ(surface_of_cloud(cloud).faces.size(), 1U);
  cloud.vertices.pop_back();
  cloud.normals.pop_back();
  EXPECT_TRUE(surface_of_cloud(cloud).faces.empty());
}

}  // namespace
}  // namespace rejoin::mesh
