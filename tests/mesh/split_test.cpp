#include "mesh/split.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "core/error.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "shapes.hpp"
#include "table_scene.hpp"

namespace rejoin::mesh {
namespace {

using test::moved;
using test::together;
using Places = std::set<std::tuple<float, float, float>>;

/// Places of the vertices for which `wanted` holds.
template <class Wanted>
Places places(const Mesh& mesh, const Wanted& wanted) {
  Places result;
  for (const glm::vec3& v : mesh.vertices) {
    if (wanted(v)) result.emplace(v.x, v.y, v.z);
  }
  return result;
}

Places places(const Mesh& mesh) {
  return places(mesh, [](const glm::vec3&) { return true; });
}

struct Disc {
  float x;
  float y;
  float radius;
  bool holds(const glm::vec3& v) const { return std::hypot(v.x - x, v.y - y) < radius; }
};

constexpr std::array kDiscs{Disc{-40, -40, 45}, Disc{50, 45, 35}, Disc{-45, 60, 25}, Disc{60, -50, 20}};

/// Flat sherds, 5 thick, on a table; a vertex each 1.
Mesh thin_sherds() {
  return test::relief(
      [](float x, float y) {
        const auto over = [&](const Disc& disc) { return disc.holds({x, y, 0}); };
        return std::ranges::any_of(kDiscs, over) ? 5.0F + 0.01F * x : 0.0F;
      },
      200);
}

TEST(Split, ThinSherdsFlatOnATableComeOutWholeButForTheCut) {
  const Mesh scan = thin_sherds();
  const Split split = mesh::split("scan", scan);
  ASSERT_TRUE(split.table);
  EXPECT_GT(split.table->up.z, 0.9999);
  ASSERT_EQ(split.pieces.size(), kDiscs.size());
  for (std::size_t k = 0; k < kDiscs.size(); ++k) {
    const auto of_disc = [&](const glm::vec3& v) { return kDiscs[k].holds(v); };
    EXPECT_EQ(places(split.pieces[k]), places(scan, of_disc)) << k;
  }
  EXPECT_EQ(split.crumbs.parts, 0U);
  EXPECT_TRUE(split.touching.empty());
}

TEST(Split, AnUnevenTableIsTakenThicker) {
  const Mesh scan = test::relief(
      [](float x, float y) {
        const float bent = 4.0F * (x * x + y * y) / 2e4F;  // up to four spacings at the corners
        return bent + std::max({0.0F, 20.0F - std::hypot(x + 40, y), 20.0F - std::hypot(x - 40, y)});
      },
      200);
  const Split split = mesh::split("scan", scan);
  ASSERT_TRUE(split.table);
  EXPECT_GT(split.cut, 1.5);  // of a spacing of one
  EXPECT_EQ(split.pieces.size(), 2U);
}

TEST(Split, CloudsOfThemToo) {
  Mesh scan = thin_sherds();
  scan.faces.clear();
  scan.colours.resize(scan.vertices.size(), {1, 2, 3});
  const Split split = mesh::split("scan", scan);
  ASSERT_TRUE(split.table);
  ASSERT_EQ(split.pieces.size(), kDiscs.size());
  for (std::size_t k = 0; k < kDiscs.size(); ++k) {
    const auto of_disc = [&](const glm::vec3& v) { return kDiscs[k].holds(v); };
    EXPECT_EQ(places(split.pieces[k]), places(scan, of_disc)) << k;
    EXPECT_EQ(split.pieces[k].colours.size(), split.pieces[k].vertices.size());
    EXPECT_TRUE(split.pieces[k].normals.empty());
  }
}

TEST(Split, TouchingPiecesAreOneUntilTheCutIsAboveTheirBridge) {
  const Mesh scan = test::relief(
      [](float x, float y) {
        const float lump = 30.0F - std::min(std::hypot(x - 28, y), std::hypot(x + 28, y));
        const float bridge = std::abs(x) < 10 && std::abs(y) < 10 ? 3.0F : 0.0F;
        return std::max({0.0F, lump, bridge});
      },
      200);
  const Split joined = mesh::split("scan", scan);
  EXPECT_EQ(joined.pieces.size(), 1U);
  EXPECT_EQ(joined.touching, std::vector<std::size_t>{0});
  SplitOptions above;
  above.cut = 4.0;
  const Split split = mesh::split("scan", scan, above);
  EXPECT_EQ(split.pieces.size(), 2U);
  EXPECT_EQ(split.cut, 4.0);
  EXPECT_TRUE(split.touching.empty());
}

TEST(Split, WholePiecesStayWholeWithAndWithoutATableThatHangsTogetherWithNone) {
  const Mesh ball = test::icosphere(20, 3);
  const Mesh slab = moved(test::box({40, 30, 8}, 8), {60, 0, -16});
  const Mesh pieces = together(ball, slab);
  for (const Mesh& scan : {pieces, together(pieces, moved(test::plate(150), {0, 0, -20}))}) {
    const Split split = mesh::split("scan", scan);
    ASSERT_EQ(split.pieces.size(), 2U);
    EXPECT_EQ(places(split.pieces[0]), places(ball));
    EXPECT_EQ(places(split.pieces[1]), places(slab));
    EXPECT_EQ(split.pieces[0].faces.size(), ball.faces.size());
    EXPECT_EQ(split.pieces[1].faces.size(), slab.faces.size());
    EXPECT_EQ(split.table.has_value(), scan.faces.size() > pieces.faces.size());
  }
}

// No plane passes between a ball and the wall of the cup around it that has no room for one.
TEST(Split, ClosedPiecesThatNoPlanePartsAreTwoAndACavityIsOfItsPiece) {
  Mesh ring;  // a torus of square section
  constexpr std::uint32_t kAround = 64;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const float turn = 6.2831853F * static_cast<float>(i) / kAround;
    for (const glm::vec2 at : {glm::vec2(40, -5), glm::vec2(50, -5), glm::vec2(50, 5), glm::vec2(40, 5)})
      ring.vertices.emplace_back(at.x * std::cos(turn), at.x * std::sin(turn), at.y);
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t a = 4 * i + k;
      const std::uint32_t b = 4 * i + (k + 1) % 4;
      const std::uint32_t c = 4 * ((i + 1) % kAround) + k;
      const std::uint32_t d = 4 * ((i + 1) % kAround) + (k + 1) % 4;
      ring.faces.insert(ring.faces.end(), {{a, c, d}, {a, d, b}});
    }
  }
  const Mesh ball = test::icosphere(20, 3);
  EXPECT_EQ(mesh::split("scan", together(ring, ball)).pieces.size(), 2U);
  Mesh cavity = test::icosphere(15, 3);
  for (glm::uvec3& face : cavity.faces) std::swap(face.y, face.z);
  EXPECT_EQ(mesh::split("scan", together(together(ring, ball), cavity)).pieces.size(), 2U);
}

// The upper patch hangs together with nothing, as above a steep side that was not seen.
TEST(Split, OnATableWhatLiesAboveEachOtherIsOnePieceAndWhatLiesBesideIsNot) {
  const Mesh lumps = test::relief(
      [](float x, float y) {
        return std::max({0.0F, 20.0F - std::hypot(x + 40, y), 20.0F - std::hypot(x - 40, y)});
      },
      200);
  Mesh patch = test::relief([](float x, float y) { return 30.0F - 0.01F * (x * x + y * y); }, 20);
  for (glm::vec3& v : patch.vertices) v = glm::vec3(0.15F * v.x - 40.0F, 0.15F * v.y, v.z + 60.0F);
  const Split split = mesh::split("scan", together(lumps, patch));
  ASSERT_TRUE(split.table);
  ASSERT_EQ(split.pieces.size(), 2U);
  EXPECT_GT(bounds(split.pieces[0]).high.z, 80.0F);
  EXPECT_LT(bounds(split.pieces[1]).high.z, 21.0F);
}

TEST(Split, OnePieceWithoutATableIsGivenBackAsItIs) {
  for (const Mesh& piece : {test::box({40, 30, 20}, 8), test::icosphere(20, 3)}) {
    const Split split = mesh::split("scan", piece);
    EXPECT_FALSE(split.table);
    ASSERT_EQ(split.pieces.size(), 1U);
    EXPECT_EQ(split.pieces[0].vertices, piece.vertices);
    EXPECT_EQ(split.pieces[0].faces, piece.faces);
  }
}

TEST(Split, CrumbsAreLeftOutAndCountedButNotWhatLiesAtAPiece) {
  const Mesh ball = test::icosphere(30, 4);
  const Mesh far = moved(test::icosphere(2, 1), {50, 0, 0});
  const Mesh near = moved(test::icosphere(2, 1), {33, 0, 0});
  const Split split = mesh::split("scan", together(together(ball, far), near));
  ASSERT_EQ(split.pieces.size(), 1U);
  EXPECT_EQ(split.pieces[0].faces.size(), ball.faces.size() + near.faces.size());
  EXPECT_EQ(split.crumbs.parts, 1U);
  EXPECT_EQ(split.crumbs.elements, far.faces.size());
  EXPECT_NEAR(split.crumbs.share, 4.0 / 908.0, 1e-3);  // by radii; of the coarse balls a little less
  SplitOptions all;
  all.least = 0.001;
  EXPECT_EQ(mesh::split("scan", together(ball, far), all).pieces.size(), 2U);
}

// A patch that a crack parts from its piece begins, in some orders of its faces, at its far end.
TEST(Split, APatchNearAPieceBelongsToItWhicheverOfItsFacesIsTheFirst) {
  const Mesh ball = test::icosphere(30, 4);                  // points some 2 apart
  Mesh patch = moved(test::box({12, 2, 2}, 6), {39, 0, 0});  // 3 off it, and its far end 15
  for (int turn = 0; turn < 2; ++turn) {
    const Split split = mesh::split("scan", together(ball, patch));
    ASSERT_EQ(split.pieces.size(), 1U);
    EXPECT_EQ(split.pieces[0].faces.size(), ball.faces.size() + patch.faces.size());
    EXPECT_EQ(split.crumbs.parts, 0U);
    for (glm::vec3& v : patch.vertices) v = glm::vec3(78.0F - v.x, v.y, -v.z);  // the other end first
  }
}

TEST(Split, ATableThatIsAskedForMustBeThereAndSomethingMustStandOnIt) {
  SplitOptions must;
  must.table = SplitOptions::TableUse::Yes;
  EXPECT_THROW(mesh::split("scan", test::icosphere(30, 4), must), InputError);
  SplitOptions above;
  above.cut = 50.0;
  EXPECT_THROW(mesh::split("scan", thin_sherds(), above), InputError);
  SplitOptions none;
  none.table = SplitOptions::TableUse::No;
  const Split split = mesh::split("scan", thin_sherds(), none);
  ASSERT_EQ(split.pieces.size(), 1U);
  EXPECT_EQ(split.pieces[0].faces.size(), thin_sherds().faces.size());
}

// A wall that is cut off by the border of the picture: no table is beyond it, but the user knows that there is one.
TEST(Split, ATableIsCutOffBelowAPieceThatReachesBeyondItIfTheUserSaysSo) {
  const Mesh scan = test::relief([](float x, float) { return x > 50 ? 30.0F : 0.0F; });
  EXPECT_FALSE(mesh::split("scan", scan).table);
  SplitOptions must;
  must.table = SplitOptions::TableUse::Yes;
  const Split split = mesh::split("scan", scan, must);
  ASSERT_EQ(split.pieces.size(), 1U);
  EXPECT_EQ(places(split.pieces[0]), places(scan, [](const glm::vec3& v) { return v.z > 1; }));
}

TEST(Split, SmallPiecesOfALargeScanAreNoSpecks) {
  const test::TemporaryFolder folder;
  const Mesh scan = together(test::relief([](float, float) { return 0.0F; }),
                             moved(test::icosphere(6, 2), {0, 0, 40}));  // 1.1 % of the table's area
  const Mesh both = together(scan, moved(test::icosphere(5, 2), {150, 0, 90}));
  save(folder / "scan.ply", both);
  EXPECT_LT(load(folder / "scan.ply").mesh.faces.size(), both.faces.size());
  const Loaded loaded = load(folder / "scan.ply", Weld::Places, Content::Several);
  EXPECT_EQ(loaded.mesh.faces.size(), both.faces.size());
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(Split, OfAFarScanThePiecesFilesHaveItsCoordinates) {
  const test::TemporaryFolder folder;
  Mesh scan = thin_sherds();
  scan.origin = {450000.0, 5400000.0, 200.0};
  const Split split = mesh::split("scan", scan);
  ASSERT_FALSE(split.pieces.empty());
  save(folder / "piece.ply", split.pieces[0]);
  const Mesh piece = load(folder / "piece.ply").mesh;
  const Box box = bounds(piece);
  EXPECT_NEAR(piece.origin.y + static_cast<double>(box.low.y), 5400000.0 - 84.0, 1e-6);
  EXPECT_NEAR(piece.origin.x + static_cast<double>(box.low.x), 450000.0 - 84.0, 1e-6);
}

}  // namespace
}  // namespace rejoin::mesh
