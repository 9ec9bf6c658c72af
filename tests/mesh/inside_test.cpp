#include "mesh/detail/inside.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mesh/samples.hpp"
#include "shapes.hpp"

namespace rejoin::mesh::detail {
namespace {

// What is told in fewer rays is what all of them tell: on a ball with a thin leaf at its side and an open sheet, wound either way.
TEST(Inside, IsThickerWhereTheThicknessIs) {
  Mesh mesh = test::icosphere(10.0F, 3);
  const auto add = [&](const Mesh& other, const glm::vec3& at) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec3& vertex : other.vertices) mesh.vertices.push_back(vertex + at);
    for (const glm::uvec3& face : other.faces) mesh.faces.push_back(face + first);
  };
  Mesh leaf = test::icosphere(4.0F, 3);
  for (glm::vec3& vertex : leaf.vertices) vertex.z *= 0.1F;
  add(leaf, {12.0F, 0.0F, 0.0F});
  Mesh sheet;
  sheet.vertices = {{-3, -3, 14}, {3, -3, 14}, {3, 3, 14}, {-3, 3, 14}};
  sheet.faces = {{0, 1, 2}, {0, 2, 3}};
  add(sheet, glm::vec3(0.0F));
  const Inside inside(mesh);
  const Samples places = sample_surface(mesh, 3000);
  std::size_t thicker = 0;
  std::size_t thinner = 0;
  for (const float limit : {0.5F, 2.0F, 15.0F}) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (const float way : {1.0F, -1.0F}) {
        const float thickness = inside.thickness_at(places.points[i], way * places.normals[i]);
        const bool told = inside.is_thicker(places.points[i], way * places.normals[i], limit);
        const bool is = thickness > limit && thickness < kNoBody;
        // Of a place whose normal points inwards it may take more rays.
        EXPECT_EQ(told, is && (way > 0 || told)) << thickness << " against " << limit;
        ++(told ? thicker : thinner);
      }
    }
  }
  EXPECT_GT(thicker, places.size());
  EXPECT_GT(thinner, places.size());
}

}  // namespace
}  // namespace rejoin::mesh::detail
