#include "report/facet_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "planted.hpp"

namespace rejoin::report {
namespace {

bool is_grey(Colour c) {
  return std::abs(c.r - c.g) < 12 && std::abs(c.g - c.b) < 12;
}

/// Share of the picture below its two lines of text that is neither grey nor paper.
double coloured_share(const Image& image) {
  std::size_t coloured = 0;
  const std::size_t from = static_cast<std::size_t>(image.width) * 70;
  for (std::size_t i = from; i < image.pixels.size(); ++i) coloured += is_grey(image.pixels[i]) ? 0 : 1;
  return static_cast<double>(coloured) / static_cast<double>(image.pixels.size() - from);
}

TEST(FacetPicture, FractureIsColouredAndOriginalSurfaceGrey) {
  const Planted planted = planted_pair();
  mesh::Segmentation facets = mesh::segment(planted.a.surface);
  ASSERT_GT(facets.facets.size(), 1U);
  for (auto& facet : facets.facets) facet.fracture = true;
  const double all = coloured_share(facet_picture(planted.a.surface, facets, "all"));
  for (auto& facet : facets.facets) facet.fracture = false;
  const double none = coloured_share(facet_picture(planted.a.surface, facets, "none"));
  EXPECT_GT(all, 0.1);  // six views of a block fill more than a tenth of their panels
  EXPECT_EQ(none, 0.0);
}

TEST(FacetPicture, NeighbouringNumbersHaveDistinctColours) {
  const Planted planted = planted_pair();
  mesh::Segmentation facets = mesh::segment(planted.a.surface);
  for (auto& facet : facets.facets) facet.fracture = true;
  for (int f = 0; f + 1 < static_cast<int>(facets.facets.size()); ++f) {
    const glm::ivec3 difference =
        glm::abs(glm::ivec3(facet_colour(f, facets)) - glm::ivec3(facet_colour(f + 1, facets)));
    EXPECT_GT(std::max({difference.x, difference.y, difference.z}), 80);
  }
}

}  // namespace
}  // namespace rejoin::report
