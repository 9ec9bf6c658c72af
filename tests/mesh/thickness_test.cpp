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

}  // namespace
}  // namespace rejoin::mesh
