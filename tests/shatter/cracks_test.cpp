#include "shatter/cracks.hpp"

#include <gtest/gtest.h>

#include "../mesh/shapes.hpp"
#include "shatter/shatter.hpp"

namespace rejoin::shatter {
namespace {

constexpr double kWide = 1e6;

/// The plane x = 0, y = 0 or z = 0; what is below lies inside.
Crack plane(int axis) {
  glm::dvec3 centre(0.0);
  centre[axis] = -kWide;
  return {centre, kWide};
}

TEST(Cracks, EndAtOlderOnes) {
  Cracks cracks(Noise{});
  cracks.add(0, plane(2));  // 0 below, 1 above,
  cracks.add(1, plane(0));  // of which x > 0 is 2
  ASSERT_EQ(cracks.pieces(), 3U);
  EXPECT_EQ(cracks.piece_of({5, 0, -1}), 0U);
  EXPECT_EQ(cracks.piece_of({-5, 0, -1}), 0U);
  EXPECT_EQ(cracks.piece_of({-5, 0, 1}), 1U);
  EXPECT_EQ(cracks.piece_of({5, 0, 1}), 2U);
  // The piece below has two others along its one side.
  EXPECT_EQ(cracks.walls({-5, 0, -1}, 0).behind, 1);
  EXPECT_EQ(cracks.walls({5, 0, -1}, 0).behind, 2);
  const Walls corner = cracks.walls({3, 0, 1}, 2);
  EXPECT_EQ(corner.behind, 0);
  EXPECT_NEAR(corner.nearest, -1.0, 1e-3);
  EXPECT_NEAR(corner.second, -3.0, 1e-3);
  EXPECT_EQ(cracks.walls({1, 0, 3}, 2).behind, 1);
}

TEST(Cracks, ThePieceInsideKeepsItsNumber) {
  Cracks cracks(Noise{});
  cracks.add(0, plane(2));
  cracks.add(0, plane(1));
  EXPECT_EQ(cracks.piece_of({0, -1, -1}), 0U);
  EXPECT_EQ(cracks.piece_of({0, 1, -1}), 2U);
  EXPECT_EQ(cracks.piece_of({0, 1, 1}), 1U);
  EXPECT_EQ(cracks.walls({0, -1, -2}, 0).behind, 2);
}

TEST(Cracks, ThereAreNoneWhereNothingLiesInside) {
  mesh::Samples skin;
  skin.points = {{0, 0, 0}};
  skin.normals = {{0, 0, 1}};
  EXPECT_FALSE(choose_cracks({}, skin, {}, 2, Noise{}, 1, Context()));
}

// A hollow ball: every sherd is one body with both walls, and all together are the ball.
TEST(Cracks, SherdsOfAVesselAreWholeAndFillIt) {
  mesh::Mesh vessel = mesh::test::icosphere(10.0F, 4);
  const mesh::Mesh hollow = mesh::test::icosphere(8.0F, 4);
  const auto first = static_cast<std::uint32_t>(vessel.vertices.size());
  vessel.vertices.insert(vessel.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const glm::uvec3& face : hollow.faces)
    vessel.faces.emplace_back(first + face.x, first + face.z, first + face.y);
  const double whole = mesh::test::volume(vessel);
  Options options;
  options.cracks = true;
  options.pieces = 7;
  options.spacing = 0.03;
  options.erosion = options.noise = options.chips = 0.0;
  const Shattered shattered = shatter("vessel", vessel, options, Context());
  ASSERT_EQ(shattered.pieces.size(), 7U);
  double sum = 0.0;
  for (const Piece& piece : shattered.pieces) {
    EXPECT_EQ(mesh::test::count_edges(piece.scan).open, 0U);
    const double volume = mesh::test::volume(piece.scan);
    EXPECT_GT(volume, 0.1 * whole / 7.0);
    sum += volume;
  }
  EXPECT_NEAR(sum / whole, 1.0, 0.05);
}

}  // namespace
}  // namespace rejoin::shatter
