#include "zbuffer/depth_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace rejoin::zbuffer {
namespace {

struct Soup {
  std::vector<glm::vec3> points;
  std::vector<glm::uvec3> faces;
};

Soup random_soup(int faces, double size, std::uint64_t seed) {
  Random random(seed);
  Soup soup;
  for (int f = 0; f < faces; ++f) {
    const glm::vec3 at(random.uniform(-8, 48), random.uniform(-8, 40), random.uniform(0, 10));
    for (int k = 0; k < 3; ++k) {
      soup.points.push_back(
          at + glm::vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-1, 1)));
    }
    const auto first = static_cast<unsigned>(3 * f);
    soup.faces.emplace_back(first, first + 1, first + 2);
  }
  return soup;
}

/// A jittered grid over the map, cut into triangles that share their edges; half of them wound the other way.
Soup tiling(int cells, double jitter, std::uint64_t seed) {
  Random random(seed);
  Soup soup;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const double move = inner ? jitter : 0.0;
      soup.points.emplace_back(32.0 * i / cells + random.uniform(-move, move),
                               32.0 * j / cells + random.uniform(-move, move), 1.0F);
    }
  }
  const auto side = static_cast<unsigned>(cells + 1);
  for (unsigned j = 0; j + 1 < side; ++j) {
    for (unsigned i = 0; i + 1 < side; ++i) {
      const unsigned p = j * side + i;
      soup.faces.emplace_back(p, p + 1, p + side + 1);
      soup.faces.emplace_back(p, p + side, p + side + 1);
    }
  }
  return soup;
}

void expect_same(const DepthMap& a, const DepthMap& b, float tolerance) {
  for (std::size_t k = 0; k < a.depth.size(); ++k) {
    ASSERT_EQ(std::isnan(a.depth[k]), std::isnan(b.depth[k])) << "pixel " << k;
    if (!std::isnan(a.depth[k])) {
      ASSERT_NEAR(a.depth[k], b.depth[k], tolerance) << "pixel " << k;
    }
  }
}

TEST(DepthMap, DrawCoversWhatTheReferenceCovers) {
  for (const double size : {0.3, 1.0, 4.0, 30.0, 4000.0}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(testing::Message() << "size " << size << ", seed " << seed);
      const Soup soup = random_soup(200, size, seed);
      DepthMap fast(40, 32);
      DepthMap slow(40, 32);
      draw(soup.points, soup.faces, fast);
      draw_reference(soup.points, soup.faces, slow);
      expect_same(fast, slow, 4e-6F);  // depths of 0 .. 11 rounded to float by two formulas
    }
  }
}

TEST(DepthMap, SharedEdgesNeitherLeakNorOverlap) {
  for (const int cells :
       {4, 8, 16, 61}) {  // at 4, 8 and 16 without jitter corners and diagonals hit pixel centres
    for (const double jitter : {0.0, 0.2}) {
      const Soup soup = tiling(cells, jitter * 8.0 / cells, 7);
      std::vector<int> hits(1024, 0);
      for (const glm::uvec3& face : soup.faces) {
        DepthMap one(32, 32);
        draw(soup.points, std::vector<glm::uvec3>{face}, one);
        for (std::size_t k = 0; k < hits.size(); ++k) hits[k] += std::isnan(one.depth[k]) ? 0 : 1;
      }
      for (const int hit : hits) ASSERT_EQ(hit, 1) << cells << " cells, jitter " << jitter;
    }
  }
}

TEST(DepthMap, CornersOnPixelCentresAreDrawnOnce) {
  // Corners exactly on pixel centres: the shared diagonal runs through centres.
  const std::vector<glm::vec3> points = {
      {2.5F, 2.5F, 1}, {10.5F, 2.5F, 1}, {10.5F, 10.5F, 1}, {2.5F, 10.5F, 1}};
  const std::vector<glm::uvec3> faces = {{0, 1, 2}, {0, 2, 3}};
  int hits = 0;
  for (const glm::uvec3& face : faces) {
    DepthMap one(16, 16);
    draw(points, std::vector<glm::uvec3>{face}, one);
    for (const float depth : one.depth) hits += std::isnan(depth) ? 0 : 1;
  }
  EXPECT_EQ(hits, 8 * 8);
}

TEST(DepthMap, NearestWinsAndExistingContentTakesPart) {
  const std::vector<glm::vec3> points = {{-100, -100, 5}, {200, -100, 5}, {-100, 200, 5}};
  const std::vector<glm::uvec3> faces = {{0, 1, 2}};
  DepthMap map(8, 8);
  map.at(3, 4) = 2.0F;
  map.at(4, 4) = 7.0F;
  draw(points, faces, map);
  EXPECT_EQ(map.at(3, 4), 2.0F);
  EXPECT_EQ(map.at(4, 4), 5.0F);
  EXPECT_EQ(map.at(0, 0), 5.0F);
}

TEST(DepthMap, BadCornersAreSkipped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec3> points = {{-50, -50, 1}, {50, -50, 1}, {0, 50, 1},  {nan, 0, 1},
                                         {0, inf, 1},   {0, 0, nan},  {1e6F, 0, 1}};
  const std::vector<glm::uvec3> faces = {{0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {0, 1, 6}, {0, 1, 1}};
  DepthMap fast(8, 8);
  DepthMap slow(8, 8);
  draw(points, faces, fast);
  draw_reference(points, faces, slow);
  for (const float depth : fast.depth) EXPECT_TRUE(std::isnan(depth));
  for (const float depth : slow.depth) EXPECT_TRUE(std::isnan(depth));
}

TEST(DepthMap, MirrorTwiceIsIdentity) {
  DepthMap map(7, 5);
  Random random(3);
  for (float& depth : map.depth)
    depth = random.uniform() < 0.3 ? kBackground : static_cast<float>(random.uniform());
  expect_same(mirrored(mirrored(map)), map, 0.0F);
  const DepthMap once = mirrored(map);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 7; ++i) {
      EXPECT_TRUE(once.at(i, j) == map.at(6 - i, j) ||
                  (std::isnan(once.at(i, j)) && std::isnan(map.at(6 - i, j))));
    }
  }
}

}  // namespace
}  // namespace rejoin::zbuffer
