#include "mesh/thickness.hpp"

#include <gtest/gtest.h>

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

TEST(Thickness, WallsThatRunParallelNearlyEverywhereNeedNotBeAsThick) {
  EXPECT_NEAR(wall_thickness(rays_of_two_walls(0.99F), 100.0), 16.0, 0.3);
  EXPECT_EQ(wall_thickness(rays_of_two_walls(0.9F), 100.0), 0.0);
}

// Two cracks of a solid object may run side by side, but they are not parallel.
TEST(Thickness, SlabBetweenCracksThatLeanOnEachOtherHasNoWall) {
  EXPECT_EQ(wall_thickness(rays_of_a_slab(0.88F), 100.0), 0.0);
  EXPECT_NEAR(wall_thickness(rays_of_a_slab(0.99F), 100.0), 10.0, 0.3);
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
