#include "mesh/flaps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "hung_sheet.hpp"
#include "shapes.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::mesh {
namespace {

using test::box;
using test::hang_sheet;

constexpr glm::vec3 kSize{30, 24, 12};

/// A box with a sheet 14 long that goes on from an edge of its underside.
Mesh box_with_sheet(float rise) {
  Mesh mesh = box(kSize, 30);
  const auto at_edge = [](const glm::vec3& v) {
    return v.x > 0.499F * kSize.x && v.z < -0.499F * kSize.z && std::abs(v.y) < 0.3F * kSize.y;
  };
  hang_sheet(mesh, at_edge, {0, 1, 0}, [rise](float along, float turn) {
    return glm::vec3(along, 0.0F, rise * along * along / 14.0F + 0.02F * std::sin(3.0F * turn));
  });
  return mesh;
}

template <class Field>
Mesh where(const Field& field, double spacing = 0.5) {
  return shatter::surface_nets(field, {.size = 64.0, .spacing = spacing}, Context{});
}

double brick(const glm::dvec3& p, const glm::dvec3& middle, const glm::dvec3& size) {
  const glm::dvec3 off = glm::abs(p - middle) - 0.5 * size;
  return std::max({off.x, off.y, off.z});
}

/// A slab, and on its right a leaf beneath its edge.
Mesh slab_with_leaf(double thickness, double spacing) {
  const auto field = [thickness](const glm::dvec3& p) {
    const double slab = brick(p, {-6, 0, 0}, glm::dvec3(kSize));
    const double end = 22.0 + 2.0 * std::sin(0.7 * p.y);
    const double leaf = brick(p, {10, 0, 0.5 * (thickness - 12.0)}, {30, 18, thickness});
    return std::min(slab, std::max(leaf, p.x - end));
  };
  return where(field, spacing);
}

void expect_no_flap(const Mesh& mesh) {
  const Flaps flaps = cut_off_flaps(mesh);
  EXPECT_FALSE(flaps.rest) << flaps.share;
  EXPECT_EQ(flaps.doubtful, 0);
}

/// The faces whose middles are kept.
template <class Kept>
Mesh part_of(const Mesh& mesh, const Kept& kept) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const glm::uvec3& face = mesh.faces[f];
    if (kept((mesh.vertices[face.x] + mesh.vertices[face.y] + mesh.vertices[face.z]) / 3.0F))
      faces.push_back(f);
  }
  return submesh(mesh, faces);
}

// A row of faces along the seam, a thirtieth of the sheet, may go with either.
TEST(Flaps, OpenSheetIsCutOffFlatOrBentAndTheRestIsThePiece) {
  const double whole = surface_area(box(kSize, 30));
  for (const float rise : {0.0F, 0.8F, -0.5F}) {
    const Mesh scan = box_with_sheet(rise);
    const double sheet = surface_area(scan) - whole;
    const Flaps flaps = cut_off_flaps(scan);
    ASSERT_TRUE(flaps.rest) << rise;
    EXPECT_NEAR(surface_area(*flaps.rest), whole, sheet / 30.0) << rise;
    EXPECT_NEAR(flaps.share, sheet / surface_area(scan), 0.01) << rise;
    EXPECT_EQ(flaps.doubtful, 0);
  }
}

TEST(Flaps, SheetThatSharesNoVertexWithThePieceIsCutOff) {
  Mesh scan = box_with_sheet(0.0F);
  const std::size_t piece = box(kSize, 30).vertices.size();
  std::map<std::uint32_t, std::uint32_t> own;  // vertices of the seam, once more for the sheet
  for (glm::uvec3& face : scan.faces) {
    if (std::max({face.x, face.y, face.z}) < piece) continue;
    for (int k = 0; k < 3; ++k) {
      if (face[k] >= piece) continue;
      const auto [at, is_new] = own.emplace(face[k], static_cast<std::uint32_t>(scan.vertices.size()));
      if (is_new) scan.vertices.push_back(scan.vertices[face[k]] + glm::vec3(0.1F, 0.0F, -0.2F));
      face[k] = at->second;
    }
  }
  const Flaps flaps = cut_off_flaps(scan);
  ASSERT_TRUE(flaps.rest);
  EXPECT_NEAR(surface_area(*flaps.rest), surface_area(box(kSize, 30)), 1e-3);
}

// The rest has a slit as high as the leaf is thick.
TEST(Flaps, LeafIsCutOff) {
  const double whole = surface_area(where([](const glm::dvec3& p) {
    return brick(p, {-6, 0, 0}, glm::dvec3(kSize));
  }));
  const Flaps flaps = cut_off_flaps(slab_with_leaf(0.9, 0.5));
  ASSERT_TRUE(flaps.rest);
  EXPECT_NEAR(surface_area(*flaps.rest), whole, 0.02 * whole);
  EXPECT_GT(flaps.share, 0.15);
}

TEST(Flaps, LeafWithAShapeOfItsOwnAtItsBorderIsLeftAndTold) {
  const Flaps flaps = cut_off_flaps(slab_with_leaf(1.3, 0.35));
  EXPECT_FALSE(flaps.rest);
  EXPECT_GT(flaps.doubtful, 0.15);
}

TEST(Flaps, AreTheSameInOtherUnitsAndPlaces) {
  const Mesh scan = slab_with_leaf(0.9, 0.5);
  Mesh moved = scan;
  moved.origin = {1e5, -2e5, 3e4};
  for (glm::vec3& v : moved.vertices) v *= 0.25F;
  const Flaps here = cut_off_flaps(scan);
  const Flaps there = cut_off_flaps(moved);
  ASSERT_TRUE(here.rest && there.rest);
  EXPECT_EQ(there.rest->faces.size(), here.rest->faces.size());
  EXPECT_EQ(there.rest->origin, moved.origin);
}

// Its top goes on as a sheet with a free border where nothing of the rest was scanned.
TEST(Flaps, TopOfAPieceWhoseOtherSidesWereNotScannedIsNone) {
  const Mesh whole = box(kSize, 30);
  for (const float from : {-10.0F, 0.0F, 6.0F}) {
    expect_no_flap(part_of(
        whole, [from](const glm::vec3& middle) { return middle.x < from || middle.z > 0.49F * kSize.z; }));
  }
  expect_no_flap(part_of(whole, [](const glm::vec3& middle) { return middle.z > -0.49F * kSize.z; }));
  expect_no_flap(
      part_of(whole, [](const glm::vec3& middle) { return std::abs(middle.z) > 0.49F * kSize.z; }));
}

TEST(Flaps, EdgesThatRunOutAreNone) {
  expect_no_flap(where([](const glm::dvec3& p) {  // from a thick back to a blade
    const double half = 0.45 + 5.0 / (1.0 + std::exp((p.x + 8.0) / 2.5));
    return 0.7 * std::max(brick(p, {0, 0, 0}, {44, 24, 30}), std::abs(p.z) - half);
  }));
}

// Most of the edge is three times thinner than what lies beside it, but it does not begin at once.
TEST(Flaps, PlateWithAVeryThinEdgeIsKeptWhole) {
  Mesh plate = box({68, 68, 6}, 80);
  for (glm::vec3& v : plate.vertices) {
    const float in = std::clamp((34.0F - std::max(std::abs(v.x), std::abs(v.y))) / 14.0F, 0.0F, 1.0F);
    v.z = (v.z / 6.0F + 0.5F) * (6.0F * in * in * in + 0.25F * in + 0.02F);
  }
  expect_no_flap(plate);
}

TEST(Flaps, FinsAndRibsAreNone) {
  expect_no_flap(where([](const glm::dvec3& p) {
    return std::min(brick(p, {0, 0, -6}, {40, 24, 10}), brick(p, {0, 0, 3}, {0.9, 18, 24}));
  }));
  expect_no_flap(where([](const glm::dvec3& p) {
    const double near = p.x - 5.0 * std::round(p.x / 5.0);
    return std::min(brick(p, {0, 0, 0}, {40, 24, 10}), brick({near, p.y, p.z}, {0, 0, 5}, {1, 24, 4}));
  }));
}

}  // namespace
}  // namespace rejoin::mesh
