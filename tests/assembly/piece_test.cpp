/// Sherds of a thin bowl, scanned so coarsely that half their wall is no more than two edges.
#include "assembly/piece.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../match/planted_block.hpp"
#include "../mesh/hung_sheet.hpp"
#include "../mesh/shapes.hpp"
#include "shatter/shatter.hpp"

namespace rejoin::assembly {
namespace {

constexpr float kRadius = 60.0F;
constexpr float kWall = 6.0F;

/// Half a ball with a wall.
mesh::Mesh bowl() {
  mesh::Mesh result = mesh::test::icosphere(kRadius, 5);
  for (glm::vec3& v : result.vertices) {
    // What is above the rim becomes the hollow: mirrored, and drawn in by the wall.
    if (v.z > 0) v = glm::vec3(v.x, v.y, -v.z) * ((kRadius - kWall) / kRadius);
  }
  return result;
}

struct Sherd {
  match::Fragment fragment;
  Rigid to_world;
};

struct Sherds {
  std::vector<Sherd> list;
  std::vector<shatter::Contact> contacts;
};

/// The same sherds for any spacing, which is a share of the bowl's diameter.
Sherds sherds_of_spacing(double spacing) {
  shatter::Options options;
  options.pieces = 5;
  options.seed = 4;
  options.spacing = spacing;
  options.chips = 0;
  const shatter::Shattered broken = shatter::shatter("bowl", bowl(), options, Context());
  Sherds sherds;
  sherds.contacts = broken.contacts;
  for (const shatter::Piece& piece : broken.pieces)
    sherds.list.push_back({match::prepare("sherd", piece.scan, Context()), piece.to_world});
  return sherds;
}

bool interpenetrate_as_broken(const Sherd& a, const Sherd& b) {
  return interpenetrate(Piece(a.fragment), Piece(b.fragment), inverse(a.to_world) * b.to_world);
}

TEST(Interpenetrate, TwoScansOfOneSherdDoHoweverCoarse) {
  const Sherds fine = sherds_of_spacing(0.01);
  const Sherds coarse = sherds_of_spacing(0.014);
  ASSERT_EQ(fine.list.size(), coarse.list.size());
  for (std::size_t k = 0; k < fine.list.size(); ++k) {
    ASSERT_NEAR(coarse.list[k].fragment.facets.wall_thickness, kWall, 0.5) << k;
    ASSERT_GT(4.0 * coarse.list[k].fragment.resolution, kWall) << "coarse it must be";
    EXPECT_TRUE(interpenetrate_as_broken(fine.list[k], coarse.list[k])) << k;
    EXPECT_TRUE(interpenetrate_as_broken(coarse.list[k], fine.list[k])) << k;
  }
}

TEST(Interpenetrate, NeighboursDoNot) {
  for (const double spacing : {0.01, 0.014}) {
    const Sherds sherds = sherds_of_spacing(spacing);
    for (const shatter::Contact& c : sherds.contacts)
      EXPECT_FALSE(interpenetrate_as_broken(sherds.list[c.a], sherds.list[c.b])) << c.a << " " << c.b;
  }
}

/// Half of a block with a sheet on the edge of its break, which leans to where the other half belongs.
mesh::Mesh half_with_flap() {
  mesh::Mesh half = match::testing::half_block(true, 48);
  const auto at_edge = [](const glm::vec3& v) {
    const double cut = match::testing::cut_height(static_cast<double>(v.x), static_cast<double>(v.y));
    return v.x > 39.9F && std::abs(v.y) < 28.0F && std::abs(static_cast<double>(v.z) - cut) < 1e-3;
  };
  mesh::test::hang_sheet(half, at_edge, {0, 1, 0},
                         [](float along, float) { return glm::vec3(-0.8F * along, 0.0F, 1.2F * along); });
  return half;
}

TEST(Interpenetrate, FlapThatLeansIntoTheNeighbourIsNoBody) {
  const match::Fragment below = match::prepare("below", half_with_flap(), Context());
  const match::Fragment above = match::prepare("above", match::testing::half_block(false, 48), Context());
  ASSERT_FALSE(below.warnings.empty());
  EXPECT_NE(below.warnings.front().find("thin sheet"), std::string::npos) << below.warnings.front();
  EXPECT_FALSE(interpenetrate(Piece(below), Piece(above), Rigid{}));
  EXPECT_FALSE(interpenetrate(Piece(above), Piece(below), Rigid{}));
}

}  // namespace
}  // namespace rejoin::assembly
