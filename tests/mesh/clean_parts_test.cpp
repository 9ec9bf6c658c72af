/// Parts of a scan beside the piece and inside it: which are left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "shapes.hpp"
#include "through_ply.hpp"

namespace rejoin::mesh {
namespace {

using test::through_ply;

/// Adds `faces` small triangles side by side, each of the given size, from a place on.
void add_strip(Mesh& mesh, const glm::vec3& at, float size, int faces) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int k = 0; k < faces + 2; ++k) {
    mesh.vertices.push_back(at +
                            size * glm::vec3(0.5F * static_cast<float>(k), static_cast<float>(k % 2), 0));
  }
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(faces); ++k) {
    const std::uint32_t v = first + k;
    mesh.faces.push_back(k % 2 == 0 ? glm::uvec3(v, v + 1, v + 2) : glm::uvec3(v, v + 2, v + 1));
  }
}

TEST(Clean, DropsSpecksFarFromThePieceAndSaysSo) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    SCOPED_TRACE(scale);
    const Mesh piece = test::icosphere(50 * scale, 3);
    Mesh dusty = piece;
    add_strip(dusty, scale * glm::vec3(0, 2000, 0), 0.5F * scale, 4);
    add_strip(dusty, scale * glm::vec3(0, 0, -90), 0.5F * scale, 1);
    const Loaded loaded = through_ply(dusty);
    EXPECT_EQ(loaded.mesh.faces, piece.faces);
    EXPECT_NEAR(diameter(loaded.mesh), 100 * scale, scale);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find("a.ply: dropped 5 of 1285 faces, in 2 small parts"), std::string::npos)
        << loaded.warnings[0];
  }
}

TEST(Clean, DropsDustThatFloatsRoundThePieceAndKeepsPatches) {
  const Mesh piece = test::icosphere(50, 5);
  Mesh dusty = piece;
  for (int k = 0; k < 80; ++k) {
    const float turn = 0.4F * static_cast<float>(k);
    const float height = -0.9F + 1.8F * static_cast<float>(k) / 79.0F;
    const float across = std::sqrt(1.0F - height * height);
    const glm::vec3 out(across * std::cos(turn), across * std::sin(turn), height);
    add_strip(dusty, (k % 4 == 0 ? 66.0F : 85.0F) * out, 0.3F, 2);
  }
  const std::size_t clean = dusty.faces.size() - 160;
  add_strip(dusty, {0, 0, 66}, 6.0F, 4);  // a patch
  add_strip(dusty, {0, 52, 0}, 0.3F, 2);  // a crumb on it
  const Loaded loaded = through_ply(dusty);
  EXPECT_EQ(loaded.mesh.faces.size(), clean + 6);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("dropped 160 of 20646 faces, in 80 small parts"), std::string::npos)
      << loaded.warnings[0];
}

// Of a block with large flat sides, one of which was scanned in patches.
TEST(Clean, KeepsPatchesOnLargeFacesAndASurfaceInShreds) {
  const Mesh fine = test::icosphere(20, 5);  // hangs on a corner of it, so that faces are small on average
  Mesh block = test::box({100, 80, 60}, 1);
  for (const glm::uvec3& f : fine.faces)
    block.faces.push_back(f + static_cast<std::uint32_t>(block.vertices.size()));
  for (const glm::vec3& v : fine.vertices) block.vertices.push_back(v + glm::vec3(50, 40, 30));
  const std::size_t faces = block.faces.size();
  for (int k = 0; k < 30; ++k)
    add_strip(block, {-30.0F + 2.0F * static_cast<float>(k), 0.0F, 30.1F}, 0.5F, 2);
  EXPECT_EQ(through_ply(block).mesh.faces.size(), faces + 60);
  Mesh shreds;
  for (int k = 0; k < 3000; ++k)
    add_strip(shreds, {5.0F * static_cast<float>(k % 60), 5.0F * static_cast<float>(k / 60), 0}, 1, 2);
  EXPECT_EQ(through_ply(shreds).mesh.faces.size(), 6000U);
}

// A piece with two cavities, one of them with a lump in it, and an open patch inside, that a scanner saw through a crack.
TEST(Clean, DropsCavitiesAndKeepsOpenPatchesInside) {
  const Mesh piece = test::icosphere(50, 3);
  Mesh scan = piece;
  const auto add = [&](Mesh part, const glm::vec3& at, bool inwards) {
    const auto first = static_cast<std::uint32_t>(scan.vertices.size());
    for (const glm::vec3& v : part.vertices) scan.vertices.push_back(at + v);
    for (const glm::uvec3& f : part.faces)
      scan.faces.push_back(first + (inwards ? glm::uvec3(f.x, f.z, f.y) : f));
  };
  add(test::icosphere(8, 2), {20, 0, 0}, true);
  add(test::icosphere(10, 2), {-15, 10, 0}, true);
  add(test::icosphere(4, 2), {-15, 10, 0}, false);
  add(test::icosphere(5, 2), {70, 0, 0}, false);  // beside it
  const std::size_t of_one = test::icosphere(5, 2).faces.size();
  const std::size_t closed = scan.faces.size();
  add_strip(scan, {0, -20, 5}, 3.0F, 6);
  const Loaded loaded = through_ply(scan);
  EXPECT_EQ(loaded.mesh.faces.size(), piece.faces.size() + of_one + 6);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("dropped " + std::to_string(3 * of_one) + " of " +
                                    std::to_string(closed + 6) + " faces, in 3 parts inside it"),
            std::string::npos)
      << loaded.warnings[0];
}

// As a handle that was modelled apart from its vessel, whichever end comes first in the file.
TEST(Clean, KeepsPartsThatEndInside) {
  Mesh scan = test::icosphere(50, 3);
  const auto first = static_cast<std::uint32_t>(scan.vertices.size());
  const Mesh handle = test::box({80, 10, 10}, 8);
  for (const glm::vec3& v : handle.vertices) scan.vertices.push_back(v + glm::vec3(60, 0, 0));
  for (const glm::uvec3& f : handle.faces) scan.faces.push_back(first + f);
  EXPECT_EQ(through_ply(scan).mesh.faces.size(), scan.faces.size());
  std::ranges::reverse(scan.faces);
  EXPECT_EQ(through_ply(scan).mesh.faces.size(), scan.faces.size());
}

TEST(Clean, KeepsPatchesNearThePieceAndLargePartsAnywhere) {
  const Mesh piece = test::icosphere(50, 3);
  const std::size_t faces = piece.faces.size();
  Mesh near = piece;
  add_strip(near, {0, 62, 0}, 3.0F, 4);    // less than a tenth of the box's diagonal (17) away
  add_strip(near, {0, 75, 0}, 3.0F, 4);    // near to the patch before
  add_strip(near, {10, 10, 10}, 3.0F, 4);  // inside
  EXPECT_EQ(through_ply(near).mesh.faces.size(), faces + 12);
  EXPECT_TRUE(through_ply(near).warnings.empty());
  Mesh two = piece;
  add_strip(two, {0, 2000, 0}, 40, 1);  // 800 of 32,200
  EXPECT_EQ(through_ply(two).mesh.faces.size(), faces + 1);
  EXPECT_TRUE(through_ply(two).warnings.empty());
}

TEST(Clean, KeepsASurfaceOfManySmallPatches) {
  Mesh patches;
  for (int k = 0; k < 150; ++k) add_strip(patches, {100.0F * static_cast<float>(k), 0, 0}, 1, 2);
  EXPECT_EQ(through_ply(patches).mesh.faces.size(), 300U);
}

}  // namespace
}  // namespace rejoin::mesh
