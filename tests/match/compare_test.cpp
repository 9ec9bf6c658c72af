#include "match/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace rejoin::match {
namespace {

using zbuffer::DepthMap;

/// A wavy sheet of 2 x 2 seen from +z (or from -z), not closed.
mesh::Mesh sheet(int n, bool up) {
  mesh::Mesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float x = 2.0F * static_cast<float>(i) / static_cast<float>(n) - 1;
      const float y = 2.0F * static_cast<float>(j) / static_cast<float>(n) - 1;
      mesh.vertices.emplace_back(x, y, 0.1F * std::sin(3 * x) * std::cos(4 * y));
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::uint32_t>(j * (n + 1) + i);
      const std::uint32_t over = at + n + 1;
      for (glm::uvec3 face : {glm::uvec3(at, at + 1, over), glm::uvec3(at + 1, over + 1, over)}) {
        if (!up) std::swap(face.y, face.z);
        mesh.faces.push_back(face);
      }
    }
  }
  return mesh;
}

Fragment fragment(bool up, int fine, int coarse) {
  Fragment result;
  result.surface = sheet(fine, up);
  result.coarse = sheet(coarse, up);
  result.diameter = mesh::diameter(result.surface);
  result.resolution = mesh::resolution(result.surface);
  return result;
}

CompareOptions quick(int resolution, int steps) {
  CompareOptions options;
  options.resolution = resolution;
  options.steps = steps;
  return options;
}

TEST(Compare, ViewOfAPoseLooksAlongTheJoint) {
  const Fragment a = fragment(true, 40, 40);
  const Fragment b = fragment(false, 40, 40);
  const PoseView view = view_of_pose(a, b, Rigid{});
  const glm::vec3 seen = view.facing.view.rotation_a * glm::vec3(0, 0, 1);
  EXPECT_GT(seen.z, 0.999F);
  const Rigid back = pose_of(view.facing.view, view.facing.offset, view.centres);
  EXPECT_LT(angle_between(back, Rigid{}), 1e-5);
  EXPECT_LT(glm::length(back.translation), 1e-5);
}

TEST(Compare, SameSurfacesMatchAndBothWaysAgree) {
  const Fragment a = fragment(true, 60, 60);
  const Fragment b = fragment(false, 60, 60);
  const Comparison result = compare(a, b, Rigid{}, quick(64, 1), Context{});
  ASSERT_EQ(result.grid.size(), 243U);
  EXPECT_LT(result.pose.drawn.error * 64, 0.01);  // planted: no slope difference but rounding
  EXPECT_GT(result.drawing_agreement.correlation, 0.999);
  EXPECT_LT(result.drawing_agreement.mean, 0.005);
  EXPECT_EQ(result.detail_agreement.max, 0);  // coarse = full here
  for (const GridPose& pose : result.grid) {
    EXPECT_GE(pose.cast.error, result.pose.cast.error - 1e-6F) << "the planted pose is the best of the grid";
  }
}

TEST(Compare, CoarseMeshesShowAsLevelOfDetailInTheInterior) {
  const Comparison result =
      compare(fragment(true, 80, 8), fragment(false, 80, 8), Rigid{}, quick(64, 0), Context{});
  const auto share = [](const RenderingDifference& difference, PixelKind kind) {
    return difference.kinds[static_cast<std::size_t>(kind)].depth_share;
  };
  EXPECT_GT(share(result.detail, PixelKind::Interior), 0.7);
  const auto interior = static_cast<std::size_t>(PixelKind::Interior);
  EXPECT_GT(result.detail.kinds[interior].depth_mean, 10 * result.drawing.kinds[interior].depth_mean);
}

TEST(RenderingDifference, CountsSilhouetteSteepAndInteriorPixels) {
  DepthMap first(8, 8);
  for (int j = 1; j < 7; ++j) {
    for (int i = 1; i < 7; ++i) first.at(i, j) = i < 5 ? 1.0F : 9.0F;  // a step of 8 pixels' width
  }
  DepthMap second = first;
  second.at(1, 1) = zbuffer::kBackground;
  second.at(3, 3) += 0.5F;
  const RenderingDifference result = rendering_difference({first, first}, {second, first}, 8.0);
  EXPECT_EQ(result.only_first, 1);
  EXPECT_EQ(result.only_second, 0);
  const auto& silhouette = result.kinds[static_cast<std::size_t>(PixelKind::Silhouette)];
  const auto& steep = result.kinds[static_cast<std::size_t>(PixelKind::Steep)];
  const auto& interior = result.kinds[static_cast<std::size_t>(PixelKind::Interior)];
  EXPECT_EQ(silhouette.pixels + steep.pixels + interior.pixels, 72);
  // The border of the 6 x 6 square, twice; in the first map (2, 1) and (1, 2) are on it already.
  EXPECT_EQ(silhouette.pixels, 40);
  EXPECT_EQ(steep.pixels, 16);  // the columns i = 4 and i = 5 between the borders, twice
  EXPECT_EQ(interior.pixels, 16);
  EXPECT_FLOAT_EQ(static_cast<float>(interior.depth_max), 0.5F);
  EXPECT_EQ(interior.depth_share, 1.0);
}

TEST(RenderingDifference, EqualRenderingsDoNotDiffer) {
  DepthMap map(8, 8);
  map.at(3, 3) = 1;
  const RenderingDifference result = rendering_difference({map, map}, {map, map}, 1.0);
  for (const KindShare& kind : result.kinds) {
    EXPECT_EQ(kind.depth_max, 0);
    EXPECT_EQ(kind.error_share, 0);
  }
}

TEST(Compare, OptionsOutOfRangeAreInputErrors) {
  const Fragment a = fragment(true, 4, 4);
  const Fragment b = fragment(false, 4, 4);
  EXPECT_THROW(compare(a, b, Rigid{}, quick(32, 9), Context{}), InputError);
  EXPECT_THROW(compare(a, b, Rigid{}, quick(2, 0), Context{}), InputError);
  EXPECT_THROW(rendering_difference({DepthMap(4, 4), DepthMap(4, 4)}, {DepthMap(4, 4), DepthMap(5, 4)}, 1.0),
               InputError);
}

}  // namespace
}  // namespace rejoin::match
