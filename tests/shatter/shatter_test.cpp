/// A broken ball: what its pieces must add up to.
#include "shatter/shatter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "../mesh/shapes.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/load.hpp"
#include "mesh/point_index.hpp"
#include "mesh/rings.hpp"
#include "shatter/division.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::shatter {
namespace {

constexpr double kRadius = 10.0;
constexpr double kBallVolume = 4.0 / 3.0 * 3.14159265358979 * kRadius * kRadius * kRadius;

/// Quick: a coarse grid.
Options coarse(int pieces) {
  Options options;
  options.pieces = pieces;
  options.spacing = 0.04;
  options.erosion = 0.0;
  options.noise = 0.0;
  options.chips = 0.0;
  return options;
}

Shattered broken_ball(const Options& options) {
  return shatter("ball", mesh::test::icosphere(static_cast<float>(kRadius), 4), options, Context());
}

/// A vertex of a piece in the object's frame.
glm::vec3 at_home(const Piece& piece, const glm::vec3& vertex) {
  return glm::vec3(piece.to_world(piece.scan.origin + glm::dvec3(vertex)));
}

double volume_of(const Shattered& shattered) {
  double sum = 0.0;
  for (const Piece& piece : shattered.pieces) sum += mesh::test::volume(piece.scan);
  return sum;
}

TEST(Shatter, EveryPieceIsClosedAndTurnedOutwards) {
  for (const Piece& piece : broken_ball(coarse(4)).pieces) {
    const mesh::test::Edges edges = mesh::test::count_edges(piece.scan);
    EXPECT_EQ(edges.open, 0U);
    EXPECT_GT(mesh::test::volume(piece.scan), 0.0);
  }
}

TEST(Shatter, PiecesWithoutWearFillTheObject) {
  // A net's corners lie on the surface, its faces inside it, and it rounds the edges of the breaks to a cell.
  EXPECT_NEAR(volume_of(broken_ball(coarse(4))) / kBallVolume, 1.0, 0.04);
}

TEST(Shatter, PiecesOfARoughScanLieInside) {
  // Its faces' normals are so rough that a nearest face tells the wrong side of points far away.
  const std::string path = std::string(REJOIN_SOURCE_DIR) + "/meshes/block/b.drc";
  const mesh::Mesh block = mesh::load(path).mesh;
  Options options = coarse(5);
  options.spacing = 0.05;
  const Shattered shattered = shatter(path, block, options, Context());
  ASSERT_EQ(shattered.pieces.size(), 5U);
  for (const Piece& piece : shattered.pieces) {
    EXPECT_LT(mesh::diameter(piece.scan), mesh::diameter(block));
  }
  EXPECT_LT(volume_of(shattered), mesh::test::volume(block));
}

TEST(Shatter, ClosedHolesAreSmoothAndCoverTheirShareOfTheBreaksAlone) {
  Options options = coarse(4);
  options.noise = 0.002;
  const Shattered seen = broken_ball(options);
  options.closed = 0.3;
  options.hole_size = 0.2;
  const Shattered unseen = broken_ball(options);
  for (std::size_t k = 0; k < seen.pieces.size(); ++k) {
    const Piece& whole = seen.pieces[k];
    const Piece& holed = unseen.pieces[k];
    ASSERT_EQ(whole.scan.faces, holed.scan.faces);
    const mesh::Rings rings(holed.scan);
    std::size_t inside = 0;
    std::size_t moved = 0;
    for (std::uint32_t v = 0; v < whole.scan.vertices.size(); ++v) {
      if (glm::length(at_home(whole, whole.scan.vertices[v])) < static_cast<float>(0.9 * kRadius)) ++inside;
      if (whole.scan.vertices[v] == holed.scan.vertices[v]) continue;
      ++moved;
      // A membrane at rest: every vertex in the middle of its ring.
      glm::vec3 sum(0.0F);
      for (const std::uint32_t beside : rings.of(v)) sum += holed.scan.vertices[beside];
      const glm::vec3 middle = sum / static_cast<float>(rings.of(v).size());
      EXPECT_LT(glm::distance(holed.scan.vertices[v], middle), 1e-3F * static_cast<float>(kRadius));
      EXPECT_LT(glm::length(at_home(whole, whole.scan.vertices[v])), static_cast<float>(kRadius));
    }
    // The last patch may exceed the share, and breaks reach farther out than what is counted as inside.
    EXPECT_GT(moved, static_cast<std::size_t>(0.25 * static_cast<double>(inside))) << k;
    EXPECT_LT(moved, static_cast<std::size_t>(0.6 * static_cast<double>(inside))) << k;
  }
}

TEST(Shatter, WearAndChipsTakeVolumeAway) {
  Options worn = coarse(4);
  worn.erosion = 0.03;
  Options chipped = coarse(4);
  chipped.chips = 30.0;
  chipped.chip_size = 0.1;
  const double whole = volume_of(broken_ball(coarse(4)));
  EXPECT_LT(volume_of(broken_ball(worn)), 0.995 * whole);
  EXPECT_LT(volume_of(broken_ball(chipped)), 0.995 * whole);
}

TEST(Shatter, TruthPutsEveryPieceBackIntoTheBall) {
  for (const Piece& piece : broken_ball(coarse(5)).pieces) {
    double farthest = 0.0;
    for (const glm::vec3& vertex : piece.scan.vertices)
      farthest = std::max(farthest, glm::length(piece.to_world(piece.scan.origin + glm::dvec3(vertex))));
    EXPECT_LT(farthest, 1.005 * kRadius);
    EXPECT_GT(farthest, 0.98 * kRadius);  // sites lie on the surface, so every piece has some of it
    EXPECT_NEAR(glm::determinant(piece.to_world.rotation), 1.0, 1e-9);
  }
}

TEST(Shatter, PiecesOfAnObjectFarFromTheOriginKeepTheirShape) {
  mesh::Mesh ball = mesh::test::icosphere(static_cast<float>(kRadius), 4);
  ball.origin = {4.5e5, -6.1e6, 120.0};
  const Shattered far = shatter("ball", ball, coarse(4), Context());
  EXPECT_NEAR(volume_of(far) / kBallVolume, 1.0, 0.04);
  for (const Piece& piece : far.pieces) {
    for (const glm::vec3& vertex : piece.scan.vertices) {
      const glm::dvec3 back = piece.to_world(piece.scan.origin + glm::dvec3(vertex));
      EXPECT_LT(glm::distance(back, ball.origin), 1.005 * kRadius);
    }
  }
}

TEST(Shatter, APlaneCutHasItsAreaAndARoughOneMore) {
  Options plane = coarse(2);
  plane.roughness = 0.0;
  const Shattered flat = broken_ball(plane);
  plane.roughness = 3.0;
  const Shattered rough = broken_ball(plane);
  ASSERT_EQ(flat.contacts.size(), 1U);
  ASSERT_EQ(rough.contacts.size(), 1U);
  EXPECT_EQ(flat.contacts[0].a, 0U);
  EXPECT_EQ(flat.contacts[0].b, 1U);
  // The bisector of two points of the ball's surface goes through its centre: a great circle's disc.
  EXPECT_NEAR(flat.contacts[0].area / (3.14159265 * kRadius * kRadius), 1.0, 0.06);
  EXPECT_GT(rough.contacts[0].area, 1.02 * flat.contacts[0].area);
}

TEST(Shatter, SameSeedSamePiecesForAnyNumberOfThreads) {
  Options options = coarse(3);
  options.noise = 0.001;
  const Shattered many = broken_ball(options);
  const ThreadLimit one(1);
  const Shattered single = broken_ball(options);
  options.seed = 2;
  const Shattered other = broken_ball(options);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(many.pieces[k].scan.vertices, single.pieces[k].scan.vertices);
    EXPECT_EQ(many.pieces[k].scan.faces, single.pieces[k].scan.faces);
    EXPECT_NE(many.pieces[k].scan.vertices, other.pieces[k].scan.vertices);
  }
}

/// How far the points of a broken ball's first piece lie off that piece without the deviation, outwards.
std::vector<double> offsets_of(const Options& with) {
  Options without = with;
  without.noise = without.correlated = 0.0;
  const mesh::Mesh exact = std::move(broken_ball(without).pieces.front().scan);
  const mesh::Mesh moved = std::move(broken_ball(with).pieces.front().scan);
  mesh::Mesh normals = exact;
  mesh::compute_normals(normals);
  std::vector<double> offsets;
  for (std::size_t v = 0; v < exact.vertices.size(); ++v)
    offsets.push_back(glm::dot(moved.vertices[v] - exact.vertices[v], normals.normals[v]));
  return offsets;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum / static_cast<double>(values.size());
}

TEST(Shatter, CorrelatedNoiseHasItsDeviationAndIsSharedByNeighbours) {
  Options options = coarse(2);
  options.spacing = 0.02;
  options.correlated = 0.004;
  options.wavelength = 0.2;
  const std::vector<double> shared = offsets_of(options);
  EXPECT_NEAR(std::sqrt(mean_square(shared)) / (2.0 * kRadius), options.correlated, 0.2 * options.correlated);
  // Points of one edge are a tenth of the wavelength apart: they differ little, where noise of single points does not.
  const mesh::Mesh scan = std::move(broken_ball(options).pieces.front().scan);
  const auto steps_of = [&](const std::vector<double>& offsets) {
    std::vector<double> steps;
    for (const glm::uvec3& face : scan.faces) steps.push_back(offsets[face.x] - offsets[face.y]);
    return mean_square(steps) / mean_square(offsets);
  };
  EXPECT_LT(steps_of(shared), 0.2);
  std::swap(options.noise, options.correlated);
  EXPECT_NEAR(steps_of(offsets_of(options)), 2.0, 0.2);
}

/// A sheet in five folds, 20 apart: pieces around sites take parts of several folds, which hang together nowhere.
mesh::Mesh folded_sheet() {
  const auto box = [](const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 out = glm::max(low - p, p - high);
    return std::max({out.x, out.y, out.z});
  };
  const Field field = [&](const glm::dvec3& p) {
    double distance = 1e300;
    for (int k = 0; k < 5; ++k) {
      const double y = 20.0 * k - 40.0;
      distance = std::min(distance, box(p, {-50, y - 4, -15}, {50, y + 4, 15}));
      const double x = k % 2 == 0 ? 46.0 : -46.0;
      if (k < 4) distance = std::min(distance, box(p, {x - 4, y, -15}, {x + 4, y + 20, 15}));
    }
    return distance;
  };
  return surface_nets(field, {glm::dmat3(1.0), glm::dvec3(0.0), 130.0, 1.5}, Context());
}

/// Area of a piece's faces that lie within reach of another piece, in the object's frame.
double area_near(const Piece& piece, const Piece& other, double reach) {
  std::vector<glm::vec3> points;
  for (const glm::vec3& vertex : other.scan.vertices) points.push_back(at_home(other, vertex));
  const mesh::PointIndex index(points);
  double area = 0.0;
  for (const glm::uvec3& face : piece.scan.faces) {
    const glm::vec3 a = at_home(piece, piece.scan.vertices[face.x]);
    const glm::vec3 b = at_home(piece, piece.scan.vertices[face.y]);
    const glm::vec3 c = at_home(piece, piece.scan.vertices[face.z]);
    if (index.nearest_within((a + b + c) / 3.0F, static_cast<float>(reach)))
      area += 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
  }
  return area;
}

TEST(Shatter, WhatIsLostTouchesNothingAndIsTold) {
  const mesh::Mesh sheet = folded_sheet();
  double lost = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Options options = coarse(4);
    options.spacing = 0.015;
    options.seed = seed;
    const Shattered broken = shatter("sheet", sheet, options, Context());
    for (const Contact& contact : broken.contacts) {
      const double seen = area_near(broken.pieces[contact.a], broken.pieces[contact.b], 4.0);
      EXPECT_GT(seen, 0.5 * contact.area) << "seed " << seed << ", " << contact.a << " and " << contact.b;
    }
    EXPECT_NEAR(broken.lost, 1.0 - volume_of(broken) / mesh::test::volume(sheet), 0.1) << "seed " << seed;
    lost = std::max(lost, broken.lost);
  }
  EXPECT_GT(lost, 0.1) << "or this tests nothing";
}

TEST(Shatter, AnOpenSurfaceIsRefused) {
  mesh::Mesh open = mesh::test::icosphere(1.0F, 2);
  open.faces.pop_back();
  EXPECT_THROW(shatter("open", open, coarse(2), Context()), InputError);
}

TEST(Shatter, EndsWhenCancelled) {
  Context context;
  context.cancel();
  EXPECT_TRUE(shatter("ball", mesh::test::icosphere(1.0F, 3), coarse(2), context).cancelled);
}

TEST(Shatter, EndsAtOnceWhenCancelledWhileItChoosesBreaks) {
  for (const bool cracks : {false, true}) {
    Options options = coarse(10000);  // more than such a ball can have
    options.cracks = cracks;
    Context* own = nullptr;
    int reports = 0;
    Context context([&](std::string_view stage, double /*fraction*/) {
      if (stage != kChoosing) return;
      ++reports;
      own->cancel();
    });
    own = &context;
    EXPECT_TRUE(shatter("ball", mesh::test::icosphere(1.0F, 3), options, context).cancelled) << cracks;
    EXPECT_EQ(reports, 1) << cracks;
  }
}

}  // namespace
}  // namespace rejoin::shatter
