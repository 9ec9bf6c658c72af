#include "report/facet_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "planted.hpp"
#include "report/numbered_picture.hpp"

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

int facet_at(const Visibility& seen, const std::vector<int>& facet_of_face, int x, int y) {
  if (x < 0 || y < 0 || x >= seen.width || y >= seen.height) return -1;
  const auto pixel = static_cast<std::size_t>(y * seen.width + x);
  return seen.body[pixel] < 0 ? -1 : facet_of_face[seen.face[pixel]];
}

/// Distance from a pixel to the nearest one of another facet, or beyond the picture.
double room_at(const Visibility& seen, const std::vector<int>& facet_of_face, int x, int y) {
  const int own = facet_at(seen, facet_of_face, x, y);
  double least = 1e9;
  for (int j = -1; j <= seen.height; ++j) {
    for (int i = -1; i <= seen.width; ++i) {
      if (facet_at(seen, facet_of_face, i, j) != own) least = std::min(least, std::hypot(i - x, j - y));
    }
  }
  return least;
}

void expect_labels_where_there_is_most_room(const Visibility& seen, const std::vector<int>& facet_of_face) {
  std::vector<double> most(64, 0.0);
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const int facet = facet_at(seen, facet_of_face, x, y);
      if (facet < 0) continue;
      double& room = most[static_cast<std::size_t>(facet)];
      room = std::max(room, room_at(seen, facet_of_face, x, y));
    }
  }
  const std::vector<PartLabel> labels = part_labels(seen, facet_of_face);
  EXPECT_EQ(labels.size(), static_cast<std::size_t>(
                               std::count_if(most.begin(), most.end(), [](double r) { return r > 0; })));
  for (const PartLabel& label : labels) {
    EXPECT_EQ(facet_at(seen, facet_of_face, label.x, label.y), label.part);
    EXPECT_NEAR(room_at(seen, facet_of_face, label.x, label.y), most[static_cast<std::size_t>(label.part)],
                1e-3);
    EXPECT_NEAR(label.room, most[static_cast<std::size_t>(label.part)], 1e-3);
  }
}

TEST(PartLabels, LieOnTheirOwnFacetInEveryView) {
  const Planted planted = planted_pair(20);
  const mesh::Segmentation facets = mesh::segment(planted.a.surface);
  const std::vector<int> facet_of_face =
      mesh::facet_of_faces(facets, mesh::sample_of_faces(facets, planted.a.surface));
  Body body;
  body.mesh = &planted.a.surface;
  const Scene scene({body});
  for (const glm::dvec3 back : {glm::dvec3(1, 2, 3), {-3, 1, -2}, {2, -3, 1}}) {
    const Camera camera = scene.overview(glm::normalize(back), {0, 1, 0});
    expect_labels_where_there_is_most_room(scene.look(camera, 40, 40), facet_of_face);
  }
}

// The middle of the ring is the disc's, and that of the two patches is paper.
TEST(PartLabels, OfARingAndOfTwoPatchesLieOnThem) {
  Visibility seen{41, 31, std::vector<int>(41 * 31, -1), std::vector<std::uint32_t>(41 * 31, 0)};
  const auto paint = [&](int x, int y, std::uint32_t facet) {
    const auto pixel = static_cast<std::size_t>(y * seen.width + x);
    seen.body[pixel] = 0;
    seen.face[pixel] = facet;
  };
  for (int y = 0; y < 31; ++y) {
    for (int x = 0; x < 31; ++x) {
      const double r = std::hypot(x - 15, y - 15);
      if (r < 14) paint(x, y, r < 6 ? 1 : 0);
    }
    if (y < 4 || y > 24) {
      for (int x = 36; x < 41; ++x) paint(x, y, 2);
    }
  }
  const std::vector<int> facet_of_face{0, 1, 2};
  expect_labels_where_there_is_most_room(seen, facet_of_face);
  EXPECT_EQ(part_labels(seen, facet_of_face).size(), 3U);
}

}  // namespace
}  // namespace rejoin::report
