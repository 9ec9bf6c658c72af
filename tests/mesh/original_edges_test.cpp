/// A sherd from the mouth of a cylindrical vessel: three breaks and a lip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "mesh/facets.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::mesh {
namespace {

constexpr double kOuter = 60.0;
constexpr double kWallOf = 6.0;
constexpr double kHeight = 60.0;  // of the lip

/// Heights of a break over the plane between its ends; slopes of up to 30 degrees at waves of 3 to 20 mm.
double relief(double along, double across) {
  return 0.9 * std::sin(0.35 * along + 0.5 * across) + 0.3 * std::sin(1.1 * along - 0.9 * across + 1.0) +
         0.14 * std::sin(2.1 * along + 1.9 * across + 2.0);
}

using Edge = std::function<double(double around, double r)>;

/// \param breaks  by which relief() of the breaks is multiplied
/// \param upper  height of the upper edge above kHeight
Segmentation sherd(double breaks, const Edge& upper) {
  const shatter::Grid grid{
      .centre = {0.7 * kOuter, 0.7 * kOuter, 0.5 * kHeight}, .size = 2.2 * kOuter, .spacing = 0.5};
  return segment(shatter::surface_nets(
      [&](const glm::dvec3& p) {
        const double r = std::hypot(p.x, p.y);
        const double around = std::atan2(p.y, p.x) * kOuter;
        const double wall = std::abs(r - kOuter + 0.5 * kWallOf) - 0.5 * kWallOf;
        return std::max({wall, breaks * relief(p.z, r) - p.y, breaks * relief(p.z + 40.0, r) - p.x,
                         breaks * relief(around + 9.0, r) - p.z, p.z - kHeight - upper(around, r)});
      },
      grid, Context{}));
}

/// Rounded from wall to wall.
double lip(double, double r) {
  const double aside = (r - kOuter + 0.5 * kWallOf) / (0.5 * kWallOf);
  return 2.0 * std::sqrt(std::max(0.0, 1.0 - aside * aside)) - 2.0;
}

/// With a knife.
double cut(double, double) {
  return 0.0;
}

/// Area of fracture facets that look up, as the upper edge does, and of all others.
struct Broken {
  double upper = 0;
  double rest = 0;
};
Broken broken(const Segmentation& s) {
  Broken area;
  for (const Facet& facet : s.facets) {
    if (facet.fracture) (facet.normal.z > 0.8 ? area.upper : area.rest) += facet.area;
  }
  return area;
}

const double kUpperArea = 0.25 * 3.14159 * (kOuter * kOuter - (kOuter - kWallOf) * (kOuter - kWallOf));
const double kRestArea = kUpperArea + 2.0 * kHeight * kWallOf;

TEST(OriginalEdges, LipOfAVesselIsNoBreak) {
  for (const Edge& edge : {Edge(lip), Edge(cut)}) {
    const Segmentation s = sherd(1.0, edge);
    EXPECT_EQ(broken(s).upper, 0.0);
    EXPECT_GT(broken(s).rest, 0.8 * kRestArea);
    // Fracture facets go first, and each sample's facet is the one that holds it.
    EXPECT_TRUE(std::ranges::is_sorted(
        s.facets, [](const Facet& a, const Facet& b) { return a.fracture && !b.fracture; }));
    for (std::size_t f = 0; f < s.facets.size(); ++f) {
      for (const auto i : s.facets[f].samples) ASSERT_EQ(s.facet_of_sample[i], static_cast<int>(f));
    }
  }
}

TEST(OriginalEdges, ABreakInTheLipsPlaceStaysOne) {
  const Broken area = broken(sherd(1.0, relief));
  EXPECT_GT(area.upper, 0.7 * kUpperArea);
  EXPECT_GT(area.rest, 0.8 * kRestArea);
}

TEST(OriginalEdges, BreaksAsSmoothAsALipStayBreaks) {
  const Broken area = broken(sherd(0.0, cut));
  EXPECT_GT(area.upper, 0.8 * kUpperArea);
  EXPECT_GT(area.rest, 0.8 * kRestArea);
}

/// Smooth, but it has the waves of a break: it does not slide.
TEST(OriginalEdges, AWornBreakStaysOne) {
  const Broken area = broken(sherd(1.0, [](double around, double) { return 1.2 * std::sin(0.22 * around); }));
  EXPECT_GT(area.upper, 0.7 * kUpperArea);
}

}  // namespace
}  // namespace rejoin::mesh
