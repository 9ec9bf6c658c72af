#include "zbuffer/detail/outward.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "shapes.hpp"
#include "zbuffer/detail/raster_kernel.hpp"
#include "zbuffer/triangles.hpp"

namespace rejoin::zbuffer::detail {
namespace {

using test::inside_out;
using test::moved;
using test::together;

std::size_t front_only(const mesh::Mesh& mesh) {
  const SidedFaces faces = sided_faces(mesh);
  EXPECT_EQ(faces.front_only.size() + faces.both.size(), mesh.faces.size());
  return faces.front_only.size();
}

TEST(SidedFaces, ClosedSurfacesThatLookOutwardsAre) {
  EXPECT_EQ(front_only(test::icosphere(1.0F, 2)), 320U);
  EXPECT_EQ(front_only(inside_out(test::icosphere(1.0F, 2))), 0U);
  EXPECT_EQ(front_only(test::height_field(1.0F, 4, [](float, float) { return 0.0F; })), 0U);
}

TEST(SidedFaces, OneHoleOneTurnedOrOneDoubledFaceOpensTheWholeComponent) {
  const mesh::Mesh whole = test::icosphere(1.0F, 1);
  mesh::Mesh hole = whole;
  hole.faces.pop_back();
  EXPECT_EQ(front_only(hole), 0U);
  mesh::Mesh turned = whole;
  std::swap(turned.faces[7].x, turned.faces[7].y);
  EXPECT_EQ(front_only(turned), 0U);
  mesh::Mesh doubled = whole;
  doubled.faces.push_back(whole.faces[3]);
  EXPECT_EQ(front_only(doubled), 0U);
}

TEST(SidedFaces, EachComponentIsOnItsOwn) {
  const mesh::Mesh ball = test::icosphere(1.0F, 1);
  mesh::Mesh open = moved(ball, {5, 0, 0});
  open.faces.pop_back();
  EXPECT_EQ(front_only(together(ball, open)), 80U);
  EXPECT_EQ(front_only(together(ball, inside_out(test::icosphere(0.5F, 2)))), 80U);  // a cavity
}

TEST(SidedFaces, LeavesTheViewAsItIs) {
  const mesh::Mesh bumpy = test::bumpy_sphere(3, 5);
  mesh::Mesh open = bumpy;
  std::erase_if(open.faces, [&](const glm::uvec3& face) { return bumpy.vertices[face.x].z > 0.6F; });
  Random random(3);
  for (const mesh::Mesh& mesh :
       {bumpy, inside_out(bumpy), open, together(moved(bumpy, {0.3F, 0.9F, 0}), open),
        together(bumpy, inside_out(test::icosphere(1.5F, 2))), together(bumpy, test::icosphere(0.4F, 2))}) {
    for (int k = 0; k < 12; ++k) {
      glm::mat3 linear = 20.0F * test::random_rotation(random);
      if (k % 2 == 1)
        linear =
            glm::mat3({1, 0, 0}, {0, 1, 0}, {0, 0, -0.05F}) * linear;  // mirrored, as fragments are scored
      const glm::vec3 offset(34.3F, 33.1F, 2.0F);
      DepthMap expected(70, 70);
      std::vector<glm::vec3> points;
      for (const glm::vec3& v : mesh.vertices) points.push_back(Projection{linear, offset}(v));
      draw(points, mesh.faces, expected);
      DepthMap map(70, 70);
      Triangles(mesh).draw(linear, offset, map);
      for (std::size_t p = 0; p < map.depth.size(); ++p) {
        ASSERT_EQ(std::isnan(map.depth[p]), std::isnan(expected.depth[p]));
        if (std::isnan(map.depth[p])) continue;
        ASSERT_NEAR(map.depth[p], expected.depth[p], 1e-4);  // roundings of coordinates up to 60: 4e-6 each
      }
    }
  }
}

TEST(SidedFaces, HalfOfASphereIsNotEvenLookedAt) {
  const TriangleSoup soup = soup_of(test::icosphere(1.0F, 4));
  const Gaze gaze = gaze_of({glm::mat3(1.0F), glm::vec3(0.0F)});
  const auto skipped = std::count_if(
      soup.cones.begin(), soup.cones.end(),
      [&](const TriangleSoup::Cone& cone) { return glm::dot(cone.axis, gaze.along) > cone.sine; });
  EXPECT_EQ(soup.cones.size(), soup.block_count());
  // Half of the sphere looks away; of that, the blocks along the silhouette hold normals that do not.
  EXPECT_GT(static_cast<double>(skipped), 0.35 * static_cast<double>(soup.cones.size()));
  EXPECT_LT(static_cast<double>(skipped), 0.5 * static_cast<double>(soup.cones.size()));
}

}  // namespace
}  // namespace rejoin::zbuffer::detail
