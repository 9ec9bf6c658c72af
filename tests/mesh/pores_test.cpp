#include "mesh/pores.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "shapes.hpp"
#include "sponge.hpp"

namespace rejoin::mesh {
namespace {

using test::box;
using test::kCell;
using test::kSpongeSize;
using test::sponge_where;

double everywhere(const glm::dvec3&) {
  return -1.0;
}

/// How deep a place lies under the sides of the slab of sponge.
double depth(const glm::dvec3& p) {
  const glm::dvec3 under = 0.5 * kSpongeSize - glm::abs(p);
  return std::min({under.x, under.y, under.z});
}

glm::dvec3 middle(const Mesh& mesh, const glm::uvec3& face) {
  return mesh.origin +
         glm::dvec3(mesh.vertices[face.x] + mesh.vertices[face.y] + mesh.vertices[face.z]) / 3.0;
}

double area_of_tables(const Mesh& mesh) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    if (std::abs(middle(mesh, mesh.faces[f]).z) > 0.5 * kSpongeSize.z - 0.1) faces.push_back(f);
  return surface_area(submesh(mesh, faces));
}

TEST(Pores, OfASpongeWhatLiesOpenIsLeft) {
  const Mesh whole = sponge_where(everywhere);
  const auto open = without_pores(whole, diameter(whole));
  ASSERT_TRUE(open);
  EXPECT_GT(area_of_tables(open->surface), 0.99 * area_of_tables(whole));
  for (const glm::uvec3& face : open->surface.faces)
    ASSERT_LT(depth(middle(open->surface, face)), 0.5 * kCell);
  EXPECT_NEAR(open->share, 1.0 - surface_area(open->surface) / surface_area(whole), 1e-9);
  EXPECT_GT(open->share, 0.3);
}

// A ball of needles is deep everywhere: without what lies in "pores" hardly anything would be left to match.
TEST(Pores, WhatIsDeepNearlyEverywhereIsKeptWhole) {
  Mesh needles = test::icosphere(10.0F, 6);
  for (glm::vec3& v : needles.vertices) {
    const glm::vec3 at = 2.5F * v;
    v *= 1.0F + 0.35F * std::pow(std::abs(std::sin(at.x) * std::sin(at.y) * std::sin(at.z)), 0.5F);
  }
  EXPECT_FALSE(without_pores(needles, diameter(needles)));
}

TEST(Pores, OfItsSidesOnlyTheCellsAreLeftOut) {
  const Mesh whole = sponge_where(everywhere);
  const auto open = without_pores(whole, diameter(whole));
  ASSERT_TRUE(open);
  const auto on_sides = [](const Mesh& mesh) {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
      if (depth(middle(mesh, mesh.faces[f])) < 0.1) faces.push_back(f);
    return surface_area(submesh(mesh, faces));
  };
  EXPECT_GT(on_sides(open->surface), 0.95 * on_sides(whole));
}

TEST(Pores, WithoutTheSpongeThereAreNone) {
  const Mesh solid = box({40, 30, 8}, 40);
  EXPECT_FALSE(without_pores(solid, diameter(solid)));
}

// A fifth of its surface and more is as deep inside as a pore, but it has two mouths.
TEST(Pores, CanalOfALongBoneIsNone) {
  const shatter::Grid grid{.size = 66.0, .spacing = 0.4};
  const Mesh bone = shatter::surface_nets(
      [](const glm::dvec3& p) {
        const double r = std::hypot(p.x, p.y);
        return std::max({r - 5.0, 1.5 - r, std::abs(p.z) - 30.0});
      },
      grid, Context{});
  EXPECT_FALSE(without_pores(bone, diameter(bone)));
}

// The valleys between splinters are as deep as pores and have as many mouths, but the other half was drawn out of them.
TEST(Pores, SplintersOfWoodAreNone) {
  const shatter::Grid grid{.size = 66.0, .spacing = 0.4};
  const Mesh wood = shatter::surface_nets(
      [](const glm::dvec3& p) {
        const double end = 12.0 + 10.0 * std::sin(1.6 * p.x) * std::sin(1.6 * p.y);
        return std::max(std::max(std::abs(p.x), std::abs(p.y)) - 12.0,
                        0.1 * std::max(p.z - end, -25.0 - p.z));
      },
      grid, Context{});
  const auto open = without_pores(wood, diameter(wood));
  EXPECT_FALSE(open) << open->share;
}

TEST(Pores, AreTheSameInOtherUnitsAndPlaces) {
  const Mesh whole = sponge_where(everywhere);
  Mesh moved = whole;
  moved.origin = {1e5, -2e5, 3e4};
  for (glm::vec3& v : moved.vertices) v *= 0.25F;
  const auto open = without_pores(whole, diameter(whole));
  const auto there = without_pores(moved, diameter(moved));
  ASSERT_TRUE(open && there);
  EXPECT_EQ(there->surface.faces.size(), open->surface.faces.size());
  EXPECT_EQ(there->surface.origin, moved.origin);
}

}  // namespace
}  // namespace rejoin::mesh
