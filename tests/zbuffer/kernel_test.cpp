#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "core/random.hpp"
#include "shapes.hpp"
#include "zbuffer/detail/fixed_triangle.hpp"
#include "zbuffer/detail/raster_kernel.hpp"
#include "zbuffer/detail/slope_sums.hpp"
#include "zbuffer/triangles.hpp"

namespace rejoin::zbuffer::detail {
namespace {

std::vector<float> random_map(int width, int height, double holes, float background, Random& random) {
  std::vector<float> map(static_cast<std::size_t>(width) * height);
  for (float& depth : map)
    depth = random.uniform() < holes ? background : static_cast<float>(random.uniform(10, 20));
  return map;
}

TEST(SlopeSums, VectorsEqualTheScalarLoop) {
  for (const float background :
       {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    for (const int width : {2, 8, 15, 16, 17, 18, 31, 32, 33, 47, 48, 49, 64, 100, 129}) {
      for (const double holes : {0.0, 0.1, 0.6, 1.0}) {
        SCOPED_TRACE(testing::Message()
                     << "width " << width << ", holes " << holes << ", background " << background);
        Random random(static_cast<std::uint64_t>(width));
        const int height = 21;
        const auto a = random_map(width, height, holes, background, random);
        const auto b = random_map(width, height, holes, background, random);
        const SlopeSums fast = slope_sums(a.data(), b.data(), width, height);
        const SlopeSums slow = slope_sums_scalar(a.data(), b.data(), width, height);
        EXPECT_EQ(fast.overlap, slow.overlap);
        EXPECT_EQ(fast.covered_a, slow.covered_a);
        EXPECT_EQ(fast.covered_b, slow.covered_b);
        // A term is rounded by up to 4 half-ulps of 40 = 8e-6 and is 14 in the mean; a lane adds a few dozen.
        EXPECT_NEAR(fast.sum, slow.sum, 1e-6 * slow.sum);
      }
    }
  }
}

TEST(SlopeSums, ReadsNothingOutsideTheMaps) {
  // Exactly sized heap blocks, so that the address sanitizer sees a read beyond them.
  for (int width = 2; width < 40; ++width) {
    const std::vector<float> a(static_cast<std::size_t>(width) * 3, 1.0F);
    const std::vector<float> b(static_cast<std::size_t>(width) * 3, 2.0F);
    EXPECT_EQ(slope_sums(a.data(), b.data(), width, 3).overlap, (width - 1) * 2);
  }
}

/// Calls body once for each instruction set that this processor has, with the dispatch bound to it.
void with_each_instruction_set(const std::function<void()>& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(SlopeSums, EveryInstructionSetGivesTheSameBits) {
  Random random(4);
  const auto a = random_map(75, 60, 0.2, HUGE_VALF, random);
  const auto b = random_map(75, 60, 0.2, HUGE_VALF, random);
  const SlopeSums first = slope_sums(a.data(), b.data(), 75, 60);
  int sets = 0;
  with_each_instruction_set([&] {
    const SlopeSums sums = slope_sums(a.data(), b.data(), 75, 60);
    EXPECT_EQ(sums.sum, first.sum);
    EXPECT_EQ(sums.overlap, first.overlap);
    ++sets;
  });
  EXPECT_GT(sets, 0);
}

TEST(DrawSoup, EveryInstructionSetGivesTheSameBits) {
  const TriangleSoup soup = soup_of(test::bumpy_sphere(4, 8));
  const ViewOptions options{.resolution = 70, .view_side = 2.8};
  const Projection projection = projection_a(test::random_poses(1, 9)[0], options);
  const auto drawn = [&] {
    std::vector<float> depth(std::size_t{70} * 70, HUGE_VALF);
    draw_soup(soup, projection, {depth.data(), 70, 70});
    return depth;
  };
  const std::vector<float> first = drawn();
  EXPECT_GT(std::ranges::count_if(first, [](float d) { return std::isfinite(d); }), 1000);
  with_each_instruction_set([&] {
    EXPECT_EQ(instruction_set(), hwy::TargetName(hwy::SupportedTargets() & HWY_TARGETS));
    const std::vector<float> again = drawn();
    EXPECT_EQ(std::memcmp(again.data(), first.data(), first.size() * sizeof(float)), 0);
  });
}

TEST(Triangles, TurnedTrianglesCoverWhatDrawCovers) {
  const mesh::Mesh m = test::bumpy_sphere(3, 8);
  const float angle = 0.7F;
  const glm::mat3 linear(glm::vec3(20 * std::cos(angle), 20 * std::sin(angle), 0),
                         glm::vec3(-20 * std::sin(angle), 20 * std::cos(angle), 0), glm::vec3(0, 0, -1));
  const glm::vec3 offset(30, 25, 2);
  DepthMap expected(60, 50);
  std::vector<glm::vec3> moved;
  for (const auto& v : m.vertices) moved.push_back(Projection{linear, offset}(v));
  draw(moved, m.faces, expected);
  DepthMap map(60, 50);
  Triangles(m).draw(linear, offset, map);
  int covered = 0;
  for (std::size_t k = 0; k < map.depth.size(); ++k) {
    ASSERT_EQ(std::isnan(map.depth[k]), std::isnan(expected.depth[k]));
    if (std::isnan(map.depth[k])) continue;
    EXPECT_NEAR(map.depth[k], expected.depth[k], 1e-5);  // sums of a few terms of about 3
    ++covered;
  }
  EXPECT_GT(covered, 500);
}

/// Triangles of 1 to 40 pixels on and around a map of 40 x 40.
/// \param on_centres  Corners lie on the centres and edges of pixels, so that many a centre lies on an edge.
mesh::Mesh scattered_triangles(std::size_t count, bool on_centres, Random& random) {
  mesh::Mesh m;
  for (std::size_t k = 0; k < count; ++k) {
    const glm::vec3 centre(random.uniform(-20, 60), random.uniform(-20, 60), random.uniform(0, 5));
    const double size = std::exp(random.uniform(0.0, std::log(40.0)));
    const auto first = static_cast<unsigned>(m.vertices.size());
    m.faces.emplace_back(first, first + 1, first + 2);
    for (int corner = 0; corner < 3; ++corner) {
      m.vertices.push_back(centre + glm::vec3(random.uniform(-size, size) / 2,
                                              random.uniform(-size, size) / 2, random.uniform(-1, 1)));
      if (on_centres) m.vertices.back() = glm::round(m.vertices.back() * 2.0F) / 2.0F;
    }
  }
  return m;
}

/// Draws into 40 x 40 pixels as draw() does.
/// \return  the pixels covered
std::size_t expect_drawn_as_by_reference(const mesh::Mesh& m) {
  DepthMap expected(40, 40);
  draw(m.vertices, m.faces, expected);
  DepthMap map(40, 40);
  Triangles(m).draw(glm::mat3(1.0F), glm::vec3(0.0F), map);
  std::size_t covered = 0;
  for (std::size_t k = 0; k < map.depth.size(); ++k) {
    EXPECT_EQ(std::isnan(map.depth[k]), std::isnan(expected.depth[k])) << "pixel " << k;
    if (std::isnan(map.depth[k])) continue;
    EXPECT_NEAR(map.depth[k], expected.depth[k], 1e-5);  // sums of a few terms of about 6
    ++covered;
  }
  return covered;
}

TEST(Triangles, OverTheEdgesOfTheMapTheyCoverWhatDrawCovers) {
  Random random(11);
  std::size_t covered = 0;
  for (int round = 0; round < 2000 && !HasFailure(); ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    // Few, so that most pixels have one triangle or none.
    covered += expect_drawn_as_by_reference(scattered_triangles(16, round % 2 == 1, random));
  }
  EXPECT_GT(covered, 100000U);
}

TEST(Triangles, LargeOnesThatHardlyReachTheMapCoverWhatDrawCovers) {
  // Of the first, edge functions leave 32 bits where the second, which is drawn in step with it, has its last pixels.
  Random random(12);
  for (int round = 0; round < 100 && !HasFailure(); ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const double low = random.uniform(-31.2, -30.5);
    const double high = random.uniform(0.5, 0.7);
    mesh::Mesh m;
    m.vertices = {{low, low, 1}, {high, low, 2}, {low, high, 3}, {0, 0, 1}, {23.9, 0, 2}, {23.9, 23.9, 3}};
    m.faces = {{0, 1, 2}, {3, 4, 5}};
    EXPECT_GT(expect_drawn_as_by_reference(m), 200U);
  }
}

TEST(DrawSoup, ACloseLookRoundsAsAFarOneDoes) {
  // A corner thousands of pixels away makes the kernel round in another way; what lies on the map stays the same.
  mesh::Mesh m = test::bumpy_sphere(4, 8);
  const Projection projection =
      projection_a(test::random_poses(1, 9)[0], {.resolution = 70, .view_side = 2.8});
  const auto drawn = [&] {
    std::vector<float> depth(std::size_t{70} * 70, HUGE_VALF);
    draw_soup(soup_of(m), projection, {depth.data(), 70, 70});
    return depth;
  };
  const std::vector<float> alone = drawn();
  const auto first = static_cast<unsigned>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), {{1e3F, 1e3F, 1e3F}, {1e3F, 1e3F, 1.001e3F}, {1.001e3F, 1e3F, 1e3F}});
  m.faces.emplace_back(first, first + 1, first + 2);
  const std::vector<float> with_far = drawn();
  EXPECT_EQ(std::memcmp(alone.data(), with_far.data(), alone.size() * sizeof(float)), 0);
}

TEST(Triangles, NoneLeaveTheMapAsItIs) {
  DepthMap map(4, 4);
  map.at(1, 2) = 5.0F;
  Triangles().draw(glm::mat3(1.0F), glm::vec3(0.0F), map);
  Triangles(mesh::Mesh()).draw(glm::mat3(1.0F), glm::vec3(0.0F), map);
  EXPECT_EQ(map.at(1, 2), 5.0F);
  EXPECT_TRUE(std::isnan(map.at(0, 0)));
}

TEST(DrawSoup, FarOutsideTheReachOfTheGridTheViewIsStillRight) {
  // A view of 1e-7 of the fragment: corners lie millions of pixels away and are not drawn, the near triangle
  // is.
  mesh::Mesh m = test::icosphere(1.0F, 2);
  const auto first = static_cast<unsigned>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), {{-1e-6F, -1e-6F, 0}, {1e-6F, -1e-6F, 0}, {0, 1e-6F, 0}});
  m.faces.emplace_back(first, first + 1, first + 2);
  std::vector<float> depth(std::size_t{64} * 64, HUGE_VALF);
  draw_soup(soup_of(m), projection_a({}, {.resolution = 64, .view_side = 2e-7}), {depth.data(), 64, 64});
  for (const float d : depth) EXPECT_NEAR(d, 1e-7F, 1e-12F);
}

}  // namespace
}  // namespace rejoin::zbuffer::detail
