#include "mesh/thickness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "facet_shapes.hpp"
#include "mesh/facets.hpp"

namespace rejoin::mesh {
namespace {

using test::box;
using test::flat;

TEST(Thickness, SolidBoxHasNoWall) {
  const Mesh mesh = box({40, 30, 20}, 20, flat);
  EXPECT_EQ(segment(mesh).wall_thickness, 0.0);
}

TEST(Thickness, PlateHasItsThickness) {
  EXPECT_NEAR(segment(box({60, 50, 4}, 30, flat)).wall_thickness, 4.0, 0.1);
}

// A rib, say: hardly wider than thick.
TEST(Thickness, RodHasNoWallAndANarrowSherdHasOne) {
  const auto bent = [](float width) {
    Mesh piece = box({70, width, 4.5F}, 70, flat);
    for (glm::vec3& v : piece.vertices) v.z += 0.004F * (v.x - 35.0F) * (v.x - 35.0F);
    return segment(piece).wall_thickness;
  };
  EXPECT_EQ(bent(9.0F), 0.0);
  EXPECT_NEAR(bent(14.0F), 4.5, 0.3);
}

// Its faces are parallel over most of it and run out into an edge.
TEST(Thickness, StruckFlakeHasNoWall) {
  Mesh flake = box({60, 40, 5}, 40, flat);
  for (glm::vec3& v : flake.vertices) {
    const glm::vec2 off(v.x / 30.0F - 1.0F, v.y / 20.0F - 1.0F);
    v.z *= std::max(0.02F, 1.0F - std::max(std::pow(std::abs(off.x), 4.0F), std::pow(std::abs(off.y), 4.0F)));
    v.z += 0.004F * (v.x - 30.0F) * (v.x - 30.0F);
  }
  EXPECT_EQ(segment(flake).wall_thickness, 0.0);
}

TEST(Thickness, SmallSherdOfAThickVesselHasItsWallAlsoWhereItBends) {
  Mesh sherd = box({40, 30, 7}, 40, flat);
  EXPECT_NEAR(segment(sherd).wall_thickness, 7.0, 0.2);
  // From its bottom to its side: both walls bend by 50 degrees.
  const float slope = std::tan(glm::radians(25.0F));
  for (glm::vec3& v : sherd.vertices) v.z += slope * std::abs(v.x - 20.0F);
  const Segmentation bent = segment(sherd);
  EXPECT_NEAR(bent.wall_thickness, 7.0 * std::cos(glm::radians(25.0)), 0.2);
  double walls = 0.0;
  for (const Facet& facet : bent.facets) walls += facet.fracture ? 0.0 : facet.area;
  EXPECT_NEAR(walls / surface_area(sherd), 0.7, 0.12);
}

TEST(Thickness, SlabWithABrokenSideHasNoWall) {
  const Mesh slab =
      box({40, 30, 7}, 60, [](float x, float y) { return 1.2F * std::sin(0.9F * x) * std::sin(0.8F * y); });
  EXPECT_EQ(segment(slab).wall_thickness, 0.0);
}

/// Rays of which two fifths leave at about a tenth of the size, at this cosine.
InwardRays rays_of_a_slab(float square) {
  InwardRays rays;
  for (int k = 0; k < 1000; ++k) {
    const bool through = k < 400;
    rays.length.push_back(through ? 10.0F + 0.005F * static_cast<float>(k - 200) : 60.0F);
    rays.square.push_back(through ? square : 0.5F);
  }
  return rays;
}

/// Rays of a piece with two walls: seven twentieths leave at a sixth of the size, a quarter at an eleventh, at this cosine.
InwardRays rays_of_two_walls(float square) {
  InwardRays rays;
  for (int k = 0; k < 1000; ++k) {
    const bool foot = k < 350;
    const bool wall = !foot && k < 600;
    const float length = foot ? 16.0F + 0.004F * static_cast<float>(k - 175) : 9.0F;
    rays.length.push_back(foot || wall ? length : 60.0F);
    rays.square.push_back(foot ? 0.99F : wall ? square : 0.5F);
  }
  return rays;
}

/// Of a piece 100 in size whose samples are all as rough, with normals along the rays that leave squarely.
double thickness_of(const InwardRays& rays) {
  const std::vector<glm::vec3> normals(rays.length.size(), glm::vec3(0, 0, 1));
  return find_walls(rays, normals, std::vector<float>(normals.size(), 0.02F), 100.0).thickness;
}

TEST(Thickness, WallsThatRunParallelNearlyEverywhereNeedNotBeAsThick) {
  EXPECT_NEAR(thickness_of(rays_of_two_walls(0.99F)), 16.0, 0.3);
  EXPECT_EQ(thickness_of(rays_of_two_walls(0.9F)), 0.0);
}

// Two cracks of a solid object may run side by side, but they are not parallel.
TEST(Thickness, SlabBetweenCracksThatLeanOnEachOtherHasNoWall) {
  EXPECT_EQ(thickness_of(rays_of_a_slab(0.88F)), 0.0);
  EXPECT_NEAR(thickness_of(rays_of_a_slab(0.99F)), 10.0, 0.3);
}

TEST(Thickness, WallsOfASmallSherdAreSmoothAndAboutFlat) {
  const InwardRays rays = rays_of_two_walls(0.9F);  // seven twentieths are parallel
  const auto walls = [&](float rough, float turn) {
    std::vector<glm::vec3> normals;
    std::vector<float> roughness;
    for (std::size_t k = 0; k < rays.length.size(); ++k) {
      const float angle = turn * static_cast<float>(k % 100);
      normals.emplace_back(std::sin(angle), 0.0F, std::cos(angle));
      roughness.push_back(rays.square[k] > 0.95F ? rough : 0.04F);
    }
    return find_walls(rays, normals, roughness, 100.0);
  };
  EXPECT_NEAR(walls(0.01F, 0.0F).thickness, 16.0, 0.3);
  EXPECT_NEAR(walls(0.01F, 0.0F).roughest, 0.02F, 1e-4F) << "between 0.01 and 0.04";
  EXPECT_EQ(walls(0.03F, 0.0F).thickness, 0.0) << "a slab between two breaks";
  const float around = glm::radians(3.6F);
  EXPECT_EQ(walls(0.01F, around).thickness, 0.0) << "a rod";
}

// As of a slab whose face is carved and whose back is sawn, breaks being as rough as in the test above.
TEST(Thickness, RougherOfTwoWallsIsNoBreak) {
  const InwardRays rays = rays_of_two_walls(0.9F);
  const std::vector<glm::vec3> normals(rays.length.size(), glm::vec3(0, 0, 1));
  std::vector<float> roughness;
  for (std::size_t k = 0; k < rays.length.size(); ++k)
    roughness.push_back(rays.square[k] <= 0.95F ? 0.04F : k % 5 < 3 ? 0.01F : 0.022F);
  const Walls walls = find_walls(rays, normals, roughness, 100.0);
  EXPECT_NEAR(walls.thickness, 16.0, 0.3);
  EXPECT_GT(walls.roughest, 0.022F + 0.005F);
  EXPECT_LT(walls.roughest, 0.04F - 0.005F);
}

TEST(Thickness, SheetThinnerThanAllThatIsCountedHasNoWall) {
  EXPECT_EQ(thickness_of({std::vector<float>(1000, 0.001F), std::vector<float>(1000, 1.0F), {}}), 0.0);
}

/// A brick with broken sides: their relief of 0.6 lies in the plane of the walls.
Mesh small_sherd(float relief) {
  const glm::vec3 size(26, 12, 7.5F);
  Mesh mesh = box(size, 60, flat);
  for (glm::vec3& v : mesh.vertices) {
    const float bump = relief * std::sin(4.5F * v.z + v.x + v.y) * std::sin(2.5F * (v.x - v.y) + 0.4F * v.z);
    v.x += bump * (v.x / size.x - 0.5F);
    v.y += bump * (v.y / size.y - 0.5F);
  }
  return mesh;
}

TEST(Thickness, SmallSherdWithRoughBreaksHasItsWallsAndABrickHasNone) {
  EXPECT_EQ(segment(small_sherd(0.0F)).wall_thickness, 0.0);
  const Segmentation s = segment(small_sherd(1.2F));
  ASSERT_NEAR(s.wall_thickness, 7.5, 0.2);
  // Its long breaks face each other in parallel, at 1.6 wall thicknesses.
  std::size_t wrong = 0;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const glm::vec3 p = s.samples.points[i];
    const bool wall = std::abs(s.normals[i].z) > 0.9F;
    if (wall && (std::min(p.x, 26 - p.x) < 1.5F || std::min(p.y, 12 - p.y) < 1.5F))
      continue;  // worn edges may be either
    if (!wall && std::min(p.z, 7.5F - p.z) < 1.0F) continue;
    ++inside;
    wrong += (s.surface[i] == Surface::Original) != wall ? 1 : 0;
  }
  EXPECT_LT(wrong, inside / 50) << "of " << inside;
}

TEST(Quarters, AreCompactPartsOfTheirFacetOfOneSizeAndHoldAllOfIt) {
  const Segmentation segmentation = segment(box({60, 50, 40}, 24, flat));
  ASSERT_GE(segmentation.facets.size(), 6U);
  const Cut parts = quarters(segmentation, segmentation, {0, 3});
  ASSERT_EQ(parts.facets.size(), 8U);
  std::size_t held = 0;
  for (const Facet& part : parts.facets) {
    const int whole = segmentation.facet_of_sample[part.samples.front()];
    EXPECT_TRUE(whole == 0 || whole == 3);
    const Facet& facet = segmentation.facets[static_cast<std::size_t>(whole)];
    for (const auto i : part.samples) EXPECT_EQ(segmentation.facet_of_sample[i], whole);
    EXPECT_NEAR(static_cast<double>(part.samples.size()), static_cast<double>(facet.samples.size()) / 4, 1.0);
    EXPECT_NEAR(part.length, facet.length / 2, 0.1 * facet.length);
    EXPECT_GT(glm::dot(part.normal, facet.normal), 0.99);
    held += part.samples.size();
  }
  EXPECT_EQ(held, segmentation.facets[0].samples.size() + segmentation.facets[3].samples.size());
}

}  // namespace
}  // namespace rejoin::mesh
