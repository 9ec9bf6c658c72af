/// Sherds of which a scan lacks surface, as where they lay on the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "match/align.hpp"
#include "match/match.hpp"
#include "shatter/surface_nets.hpp"

namespace rejoin::match {
namespace {

constexpr glm::dvec3 kHalfSherd{30, 20, 2};

double crack_at(double y) {
  return 1.5 * std::sin(0.21 * y) + 0.8 * std::sin(0.55 * y + 1.0) + 0.4 * std::sin(1.3 * y + 0.4);
}

/// A part of a plate 4 thick that is broken across.
mesh::Mesh part(bool left) {
  const shatter::Grid grid{.size = 2.4 * kHalfSherd.x, .spacing = 0.4};
  return shatter::surface_nets(
      [left](const glm::dvec3& p) {
        const glm::dvec3 off = glm::abs(p) - kHalfSherd;
        const double side = p.x - crack_at(p.y);
        return std::max({off.x, off.y, off.z, left ? side : -side});
      },
      grid, Context{});
}

/// Without the underside next to the break.
mesh::Mesh as_it_lay(mesh::Mesh scan) {
  std::erase_if(scan.faces, [&](const glm::uvec3& face) {
    const glm::vec3 middle = (scan.vertices[face.x] + scan.vertices[face.y] + scan.vertices[face.z]) / 3.0F;
    return std::abs(middle.x) < 8.0F && middle.z < -1.9F;
  });
  return scan;
}

double walls_that_go_on(const Fragment& a, const Fragment& b) {
  return Joint(a, b).evidence(to_origins(a, b, Rigid{}), 0).wall_share;
}

TEST(OpenScan, WallsGoOnThereWhereTheirOtherSideIsMissing) {
  const Fragment whole = prepare("whole", part(true), Context{});
  const Fragment lain = prepare("lain", as_it_lay(part(false)), Context{});
  EXPECT_GT(walls_that_go_on(lain, whole), 0.8);
  EXPECT_GT(walls_that_go_on(whole, lain), 0.8);
  const Result result = match(whole, lain, Options{}, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_LT(angle_between(result.candidates[0].pose, Rigid{}), 0.03);
  EXPECT_EQ(result.verdict, Verdict::Join);
}

// As of two scans, from above and from below, that were laid together.
TEST(OpenScan, ASherdWithoutItsEdgesIsToldAsOneOnWhichNoBreakIsSeen) {
  const shatter::Grid grid{.size = 2.4 * kHalfSherd.x, .spacing = 0.4};
  const auto bent = [](const glm::dvec3& p) {
    const double level = 0.01 * (p.x * p.x + p.y * p.y) - 2.0;
    const glm::dvec3 off = glm::abs(glm::dvec3(p.x, p.y, p.z - level)) - kHalfSherd;
    return std::max({off.x, off.y, off.z, p.x - crack_at(p.y)});
  };
  const auto told = [](const mesh::Mesh& scan) {
    const Fragment sherd = prepare("sherd", scan, Context{});
    EXPECT_GT(sherd.facets.wall_thickness, 3.0);
    return std::ranges::any_of(sherd.warnings, [](const std::string& warning) {
      return warning.find("no break is seen") != std::string::npos;
    });
  };
  mesh::Mesh scan = shatter::surface_nets(bent, grid, Context{});
  EXPECT_FALSE(told(scan));
  std::erase_if(scan.faces, [&](const glm::uvec3& face) {
    const glm::vec3& corner = scan.vertices[face.x];
    const glm::vec3 across = glm::cross(scan.vertices[face.y] - corner, scan.vertices[face.z] - corner);
    return std::abs(glm::normalize(across).z) < 0.6F;
  });
  EXPECT_TRUE(told(scan));
}

// At a pose at which it is turned over about the seam, walls lie on walls, but nothing goes on.
TEST(OpenScan, WallsDoNotGoOnWhereThePiecesLieOnEachOther) {
  const Fragment whole = prepare("whole", part(true), Context{});
  const Fragment lain = prepare("lain", as_it_lay(part(false)), Context{});
  const Rigid over{axis_rotation({0, 1, 0}, 1.2), {0, 0, 0}};
  EXPECT_LT(Joint(lain, whole).evidence(to_origins(lain, whole, over), 0).wall_share, 0.5);
}

}  // namespace
}  // namespace rejoin::match
