#include "mesh/painted_facets.hpp"

#include <gtest/gtest.h>

#include "facet_shapes.hpp"
#include "mesh/facets.hpp"

namespace rejoin::mesh {
namespace {

using test::box;
using test::flat;
using test::shell;

/// The mesh with every face in the colour of its facet, corners not shared, as a painting program saves it.
Mesh painted_by(const Mesh& mesh, const std::vector<glm::u8vec3>& colour_of_face) {
  Mesh painted;
  painted.origin = mesh.origin;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto first = static_cast<std::uint32_t>(painted.vertices.size());
    for (int corner = 0; corner < 3; ++corner) {
      painted.vertices.push_back(mesh.vertices[mesh.faces[f][corner]]);
      painted.colours.push_back(colour_of_face[f]);
    }
    painted.faces.emplace_back(first, first + 1, first + 2);
  }
  return painted;
}

TEST(PaintedFacets, OneSideOfABoxInTwoColoursIsTwoFractureFacets) {
  const Mesh mesh = box({40, 30, 20}, 20, flat);
  std::vector<glm::u8vec3> colours;
  for (const glm::uvec3& face : mesh.faces) {
    const glm::vec3 middle = (mesh.vertices[face.x] + mesh.vertices[face.y] + mesh.vertices[face.z]) / 3.0F;
    const bool top = middle.z > 19.9F;
    colours.push_back(!top            ? glm::u8vec3(190)
                      : middle.x < 10 ? glm::u8vec3(250, 20, 20)
                                      : glm::u8vec3(20, 20, 250));
  }
  const auto found = segment(mesh);
  const auto painted = painted_facets(found, mesh.origin, painted_by(mesh, colours));
  ASSERT_TRUE(painted);
  EXPECT_EQ(painted->left_out, 0U);
  const Segmentation* s = &painted->segmentation;
  std::vector<const Facet*> fracture;
  for (const Facet& facet : s->facets) {
    if (facet.fracture) fracture.push_back(&facet);
  }
  ASSERT_EQ(fracture.size(), 2U);
  EXPECT_NEAR(fracture[0]->area, 30 * 30, 0.06 * 900);  // a row of samples at the edges may go either way
  EXPECT_NEAR(fracture[1]->area, 10 * 30, 0.12 * 300);
  EXPECT_GT(fracture[1]->normal.z, 0.99);
  EXPECT_EQ(s->facets.size(), 2U + 5U);  // the other sides are original surface now
  EXPECT_TRUE(s->creased.facets.empty());
  for (const std::uint32_t i : fracture[0]->samples) EXPECT_EQ(s->surface[i], Surface::Fracture);
}

TEST(PaintedFacets, ColourOnAFewFacesIsNoFacetAndCounted) {
  const Mesh mesh = box({40, 30, 20}, 20, flat);
  std::vector<glm::u8vec3> colours(mesh.faces.size(), {250, 20, 20});
  colours.front() = {20, 20, 250};  // one of 4,800 faces
  const auto painted = painted_facets(segment(mesh), mesh.origin, painted_by(mesh, colours));
  ASSERT_TRUE(painted);
  EXPECT_EQ(painted->segmentation.facets.size(), 1U);
  EXPECT_EQ(painted->left_out, 1U);
}

// Nothing lies behind a scan from one side; where a user says what is broken, that is no sign of a wall.
TEST(PaintedFacets, WhatIsPaintedIsNoWallThoughNothingLiesBehindIt) {
  const Mesh whole = box({40, 30, 20}, 20, flat);
  std::vector<std::uint32_t> top;
  for (std::uint32_t f = 0; f < whole.faces.size(); ++f) {
    const glm::uvec3& face = whole.faces[f];
    if (std::min({whole.vertices[face.x].z, whole.vertices[face.y].z, whole.vertices[face.z].z}) > 19.9F)
      top.push_back(f);
  }
  const Mesh mesh = submesh(whole, top);
  const Segmentation found = segment(mesh);
  EXPECT_EQ(unbacked_share(found), 1.0);
  EXPECT_LT(unbacked_share(segment(whole)), 0.01);
  const std::vector<glm::u8vec3> colours(mesh.faces.size(), {250, 20, 20});
  const auto painted = painted_facets(found, mesh.origin, painted_by(mesh, colours));
  ASSERT_TRUE(painted);
  EXPECT_EQ(unbacked_share(painted->segmentation), 0.0);
}

TEST(PaintedFacets, FacetsThatNobodyChangedAreThereAgain) {
  const Mesh mesh = box({60, 1, 1}, 20, flat);  // a rod, whose ends are hardly larger than the smallest facet
  const Segmentation found = segment(mesh);
  ASSERT_EQ(found.facets.size(), 6U);
  const std::vector<int> facets = facet_of_faces(found, sample_of_faces(found, mesh));
  std::vector<glm::u8vec3> colours;
  for (const int facet : facets) {
    colours.push_back(facet < 0 ? glm::u8vec3(60) : glm::u8vec3(250, 30 * facet, 255 - 30 * facet));
  }
  const auto painted = painted_facets(found, mesh.origin, painted_by(mesh, colours));
  ASSERT_TRUE(painted);
  EXPECT_EQ(painted->segmentation.facets.size(), found.facets.size());
  EXPECT_EQ(painted->left_out, 0U);
}

TEST(PaintedFacets, PaintOfAnotherOriginIsFound) {
  Mesh mesh = shell(60, 40);
  mesh.origin = {1000, -500, 20};
  const auto found = segment(mesh);
  Mesh painted = painted_by(mesh, std::vector<glm::u8vec3>(mesh.faces.size(), {250, 20, 20}));
  for (glm::vec3& v : painted.vertices) v += glm::vec3(7, 8, 9);
  painted.origin -= glm::dvec3(7, 8, 9);
  const auto by_paint = painted_facets(found, mesh.origin, painted);
  ASSERT_TRUE(by_paint);
  const Segmentation* s = &by_paint->segmentation;
  ASSERT_EQ(s->facets.size(), 1U);
  EXPECT_TRUE(s->facets[0].fracture);
  EXPECT_EQ(s->facets[0].samples.size(), s->samples.size());
}

TEST(PaintedFacets, PaintOfAnotherPieceIsRefused) {
  const Mesh mesh = shell(60, 40);
  const Mesh other = box({40, 30, 20}, 20, flat);
  const auto paint = painted_by(other, std::vector<glm::u8vec3>(other.faces.size(), {250, 20, 20}));
  EXPECT_FALSE(painted_facets(segment(mesh), mesh.origin, paint));
}

}  // namespace
}  // namespace rejoin::mesh
