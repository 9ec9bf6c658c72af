#include "outline/polygon.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "outline/outline.hpp"
#include "shapes.hpp"

namespace rejoin::outline {
namespace {

/// Every pair of edges, without a grid.
bool crosses_by_brute_force(const std::vector<glm::dvec2>& p) {
  const auto side = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const glm::dvec2 a = p[i];
      const glm::dvec2 b = p[(i + 1) % n];
      const glm::dvec2 c = p[j];
      const glm::dvec2 d = p[(j + 1) % n];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  }
  return false;
}

TEST(Polygon, CrossingsAreFoundAsByComparingAllEdges) {
  Random random(11);
  int crossing = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<glm::dvec2> polygon = testing::circle(10.0, 30);
    for (glm::dvec2& p : polygon) p += 1.2 * glm::dvec2(random.normal(), random.normal());
    const bool expected = crosses_by_brute_force(polygon);
    EXPECT_EQ(find_crossing(polygon).has_value(), expected) << trial;
    crossing += expected ? 1 : 0;
  }
  EXPECT_GT(crossing, 20);
  EXPECT_LT(crossing, 180);
}

TEST(Polygon, SmallLoopIsCutOffWithANote) {
  std::vector<glm::dvec2> polygon{{0, 0},    {100, 0},  {100, 100}, {51, 100},
                                  {49, 102}, {51, 102}, {49, 100},  {0, 100}};
  std::vector<std::string> notes;
  const auto mended = mend_polygon(polygon, "a.csv", notes);
  EXPECT_FALSE(find_crossing(mended));
  EXPECT_NEAR(signed_area(mended), 10000.0, 2.0);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("a.csv"), std::string::npos);
}

TEST(Polygon, LoopsOfARoughBorderAreCutOffHoweverManyThereAre) {
  Random random(5);
  std::vector<glm::dvec2> polygon = testing::circle(1000.0, 12000);
  for (glm::dvec2& p : polygon) p += 0.7 * glm::dvec2(random.normal(), random.normal());
  std::vector<std::string> notes;
  const auto mended = mend_polygon(polygon, "rough.csv", notes);
  EXPECT_FALSE(find_crossing(mended));
  EXPECT_GT(mended.size(), polygon.size() / 2);
  EXPECT_NEAR(signed_area(mended), M_PI * 1e6, 2e3);
  ASSERT_EQ(notes.size(), 1U);
  const std::size_t count = notes[0].find("itself; ") + 8;
  EXPECT_GT(std::stoi(notes[0].substr(count)), 500) << notes[0];
}

// The loop at the crossing that holds the first point may be the small one.
TEST(Polygon, SmallLoopAtTheFirstPointIsCutOff) {
  std::vector<std::string> notes;
  const auto mended =
      mend_polygon({{50, 103}, {49, 100}, {0, 100}, {0, 0}, {100, 0}, {100, 100}, {48, 102}}, "a.csv", notes);
  EXPECT_FALSE(find_crossing(mended));
  EXPECT_NEAR(signed_area(mended), 10000.0, 150.0);
  EXPECT_EQ(notes.size(), 1U);
}

TEST(Polygon, BowTieIsRefusedWithThePlace) {
  std::vector<std::string> notes;
  try {
    mend_polygon({{0, 0}, {10, 10}, {10, 0}, {0, 12}}, "bow.csv", notes);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bow.csv: the outline crosses itself"), std::string::npos)
        << error.what();
  }
}

TEST(Polygon, TriangleAndLineAndNanAreRefused) {
  std::vector<std::string> notes;
  EXPECT_THROW(mend_polygon({{0, 0}, {1, 0}, {0, 1}}, "x", notes), InputError);
  EXPECT_THROW(mend_polygon({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, "x", notes), InputError);
  EXPECT_THROW(mend_polygon({{0, 0}, {1, 0}, {1, 1}, {NAN, 1}}, "x", notes), InputError);
}

TEST(Polygon, ClockwiseBorderIsTurnedAround) {
  std::vector<std::string> notes;
  const auto mended = mend_polygon({{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}}, "x", notes);
  EXPECT_EQ(mended, (std::vector<glm::dvec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));  // from the same point on
  EXPECT_DOUBLE_EQ(signed_area(mended), 1.0);
}

TEST(Polygon, InnerPointLiesInsideThoughTheMiddleDoesNot) {
  const std::vector<glm::dvec2> bow{{0, 0}, {10, 0}, {10, 6}, {7, 6}, {7, 2}, {2, 2}, {2, 6}, {0, 6}};
  EXPECT_EQ(inner_point(bow), glm::dvec2(8.5, 3.0));
  EXPECT_TRUE(contains(bow, inner_point(bow)));
  const std::vector<std::vector<glm::dvec2>> frame{{{0, 0}, {10, 0}, {10, 10}, {0, 10}},
                                                   {{1, 1}, {1, 9}, {8, 9}, {8, 1}}};
  EXPECT_EQ(inner_point(frame), glm::dvec2(9.0, 5.0)) << "beside the hole";
}

}  // namespace
}  // namespace rejoin::outline
