/// What the page of a run is made of.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <limits>
#include <map>

#include "planted.hpp"
#include "report/assembly_gaps.hpp"
#include "report/detail/page_geometry.hpp"
#include "report/detail/page_json.hpp"

namespace rejoin::report {
namespace {

TEST(PackedMesh, GivesTheSurfaceBackToAStepOfItsGrid) {
  mesh::Mesh mesh = ball(3, 12);
  mesh.origin = {1e6, -2e6, 5};
  const detail::PackedMesh packed = detail::pack(mesh, {}, 1);
  ASSERT_EQ(packed.vertices, mesh.vertices.size());
  ASSERT_EQ(packed.faces, mesh.faces.size());
  std::vector<std::uint16_t> grid(4 * packed.vertices);
  std::vector<unsigned int> corners(3 * packed.faces);
  ASSERT_EQ(0, meshopt_decodeVertexBuffer(grid.data(), packed.vertices, 8, packed.vertex_stream.data(),
                                          packed.vertex_stream.size()));
  ASSERT_EQ(0, meshopt_decodeIndexBuffer(corners.data(), corners.size(), packed.index_stream.data(),
                                         packed.index_stream.size()));
  double volume = 0;
  const auto at = [&](unsigned int k) {
    return packed.low - mesh.origin + packed.step * glm::dvec3(grid[4 * k], grid[4 * k + 1], grid[4 * k + 2]);
  };
  for (std::size_t k = 0; k < corners.size(); k += 3)
    volume += glm::dot(at(corners[k]), glm::cross(at(corners[k + 1]), at(corners[k + 2]))) / 6;
  double expected = 0;
  for (const glm::uvec3& f : mesh.faces)
    expected += glm::dot(glm::dvec3(mesh.vertices[f.x]),
                         glm::cross(glm::dvec3(mesh.vertices[f.y]), glm::dvec3(mesh.vertices[f.z]))) /
                6;
  EXPECT_NEAR(volume, expected, 4e-4 * expected);  // a step is 6 / 65535 of the radius 3, the area 4 pi r^2
  for (unsigned int k = 0; k < packed.vertices; ++k) EXPECT_NEAR(glm::length(at(k)), 3, 2e-4);
}

TEST(PackedMesh, KeepsGapsAsBytes) {
  mesh::Mesh mesh = ball(1, 8);
  std::vector<float> gaps(mesh.vertices.size(), std::numeric_limits<float>::quiet_NaN());
  gaps[0] = -5;  // beyond the scale
  gaps[1] = 0;
  const detail::PackedMesh packed = detail::pack(mesh, gaps, 0.5);
  std::vector<std::uint8_t> bytes(8 * packed.vertices);
  ASSERT_EQ(0, meshopt_decodeVertexBuffer(bytes.data(), packed.vertices, 8, packed.vertex_stream.data(),
                                          packed.vertex_stream.size()));
  std::map<int, int> seen;
  for (std::size_t k = 0; k < packed.vertices; ++k) ++seen[bytes[8 * k + 6]];
  EXPECT_EQ(seen[0], static_cast<int>(packed.vertices) - 2);
  EXPECT_EQ(seen[1], 1);
  EXPECT_EQ(seen[128], 1);
}

TEST(Base64, IsThatOfTheStandard) {
  const auto of = [](const std::string& text) { return detail::base64({text.begin(), text.end()}); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");  // RFC 4648, section 10
  EXPECT_EQ(of("\xff\xfe\xfd"), "//79");
}

TEST(AssemblyGaps, AreThePlantedOnesAndStayWithinAnObject) {
  const Planted pair = planted_pair(20);
  const Rigid lifted = Rigid{glm::dmat3(1.0), {0, 0, 0.02}} * pair.pose;
  const std::vector<PlacedSurface> together{{&pair.a.surface, Rigid{}, 0}, {&pair.b.surface, lifted, 0}};
  const auto gaps = assembly_gaps(together, 0.1, Context());
  double sum = 0;
  int touching = 0;
  for (const float gap : gaps[0]) {
    if (std::isnan(gap)) continue;
    sum += gap;
    ++touching;
  }
  EXPECT_GT(touching, 100);
  EXPECT_NEAR(sum / touching, 0.0195, 0.001);  // the cut rises by up to 0.4: as in Joint.KeepsAKnownGap
  const std::vector<PlacedSurface> separate{{&pair.a.surface, Rigid{}, 0}, {&pair.b.surface, lifted, 1}};
  const auto apart = assembly_gaps(separate, 0.1, Context());
  for (const float gap : apart[0]) EXPECT_TRUE(std::isnan(gap));
}

TEST(GapScale, ChipsLeaveItAlone) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(gap_scale({{0.1F, none, -0.1F}, {0.1F, -0.1F, 0.1F}}, 10), 0.5);  // 0.4 rounded up
  EXPECT_EQ(gap_scale({{0.1F, none, -0.1F}, {0.1F, 9.0F, 9.0F}}, 10), 0.5);
  EXPECT_EQ(gap_scale({{9.0F}, {}}, 10), 5) << "the half of the reach at most";
  EXPECT_EQ(gap_scale({{none}, {}}, 10), 5);
  EXPECT_GT(gap_scale({{0.0F}}, 10), 0);
}

TEST(ScoreTriangle, HoldsEveryPairOnceWhicheverComesFirst) {
  RunReport report;
  report.fragments.resize(4);
  report.pairs.push_back({3, 1, 0.5, "join", false, std::nullopt, {}, {}});
  report.pairs.push_back({0, 2, 1.5, "join", false, std::nullopt, {}, {}});
  report.pairs.push_back({2, 3, 0, "failed: is no mesh", false, std::nullopt, {}, {}, Comparison::Failed});
  EXPECT_EQ(detail::score_triangle(report), (std::vector<std::uint8_t>{255, 253, 255, 255, 127, 254}));
}

}  // namespace
}  // namespace rejoin::report
