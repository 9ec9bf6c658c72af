/// The bound against the depth itself, on a ball, a thin shell of two spheres and a box.
#include "assembly/depth_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../mesh/shapes.hpp"
#include "core/random.hpp"

namespace rejoin::assembly {
namespace {

/// A ball with a hollow in it.
mesh::Mesh shell(float outer, float inner) {
  mesh::Mesh result = mesh::test::icosphere(outer, 3);
  mesh::Mesh hollow = mesh::test::icosphere(inner, 3);
  const auto first = static_cast<std::uint32_t>(result.vertices.size());
  result.vertices.insert(result.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const glm::uvec3& face : hollow.faces)
    result.faces.push_back(glm::uvec3(face.x, face.z, face.y) + first);  // looks into the hollow
  return result;
}

/// Calls check(bound, depth, size of the surface) at points in a cube twice as large as each surface's box.
template <typename Check>
void at_points(const Check& check) {
  for (const mesh::Mesh& surface :
       {mesh::test::icosphere(10.0F, 3), shell(10.0F, 9.0F), mesh::test::box({30.0F, 2.0F, 7.0F}, 8)}) {
    const match::GapField gap(surface);
    const DepthBound bound(gap);
    const mesh::Box box = mesh::bounds(surface);
    const glm::vec3 edges = box.high - box.low;
    const float size = std::max({edges.x, edges.y, edges.z});
    Random random(7);
    for (int k = 0; k < 20000; ++k) {
      const glm::vec3 share(random.uniform(), random.uniform(), random.uniform());
      const glm::vec3 point = 0.5F * (box.low + box.high) + 2.0F * size * (share - 0.5F);
      check(bound.at(point), std::max(0.0F, -gap.at(point, 1e9F)->gap), size);
    }
  }
}

TEST(DepthBound, IsNeverBelowTheDepth) {
  at_points([](float bound, float depth, float size) { ASSERT_GE(bound, depth - 1e-5F * size); });
}

TEST(DepthBound, IsAboveTheDepthByACubesDiagonalAtMost) {
  at_points([](float bound, float depth, float size) {
    const float diagonal = std::sqrt(3.0F) * size / 40.0F;
    ASSERT_LE(bound, depth + 1.001F * diagonal);
  });
}

}  // namespace
}  // namespace rejoin::assembly
