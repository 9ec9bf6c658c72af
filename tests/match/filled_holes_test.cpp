#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "core/angle.hpp"
#include "core/random.hpp"
#include "match/match.hpp"
#include "planted_block.hpp"
#include "shatter/shatter.hpp"

namespace rejoin::match {
namespace {

using testing::kHalfX;
using testing::kHalfY;
using testing::kHalfZ;

/// A scan of half of the planted block with edges of a millimetre on all sides, in its own frame.
mesh::Mesh scanned_half(bool below, std::uint64_t seed) {
  mesh::Mesh mesh;
  std::map<std::array<long, 3>, std::uint32_t> known;
  const auto vertex = [&](const glm::dvec3& p) {
    const auto [entry, added] = known.try_emplace({std::lround(p.x), std::lround(p.y), std::lround(p.z)},
                                                  static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.emplace_back(p);
    return entry->second;
  };
  const auto sheet = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int m, int n) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < m; ++i) {
        const glm::dvec3 p = corner + 1.0 * i * u + 1.0 * j * v;
        mesh.faces.emplace_back(vertex(p), vertex(p + u), vertex(p + u + v));
        mesh.faces.emplace_back(vertex(p), vertex(p + u + v), vertex(p + v));
      }
    }
  };
  const glm::dvec3 low(-kHalfX, -kHalfY, below ? -kHalfZ : 0.0);
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 y(0, 1, 0);
  const glm::dvec3 z(0, 0, 1);
  sheet(low, y, x, 2 * kHalfY, 2 * kHalfX);
  sheet(low + kHalfZ * z, x, y, 2 * kHalfX, 2 * kHalfY);
  sheet(low, x, z, 2 * kHalfX, kHalfZ);
  sheet(low + 2.0 * kHalfY * y, z, x, kHalfZ, 2 * kHalfX);
  sheet(low, z, y, kHalfZ, 2 * kHalfY);
  sheet(low + 2.0 * kHalfX * x, y, z, 2 * kHalfY, kHalfZ);
  // The side of the cut goes up and down with it, and what is beside it in proportion.
  Random random(seed);
  for (glm::vec3& v : mesh.vertices) {
    const double share = below ? (v.z + kHalfZ) / kHalfZ : 1.0 - v.z / kHalfZ;
    v.z += static_cast<float>(share * testing::cut_height(v.x, v.y));
    v += glm::vec3(glm::dvec3(random.normal(), random.normal(), random.normal()) * 0.03);
  }
  return mesh;
}

constexpr double kRadius = 19.0;

bool in_hole(const glm::vec3& p, const glm::dvec2& middle) {
  return glm::distance(glm::dvec2(p.x, p.y), middle) < kRadius && std::abs(p.z) < 0.6 * kHalfZ;
}

/// Closes a hole in the break as software does: with a membrane.
void close_hole(mesh::Mesh& mesh, const glm::dvec2& middle) {
  for (int step = 0; step < 800; ++step) {
    std::vector<glm::vec3> sums(mesh.vertices.size(), glm::vec3(0.0F));
    std::vector<float> counts(mesh.vertices.size(), 0.0F);
    for (const glm::uvec3& face : mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        if (!in_hole(mesh.vertices[face[k]], middle)) continue;
        sums[face[k]] += mesh.vertices[face[(k + 1) % 3]] + mesh.vertices[face[(k + 2) % 3]];
        counts[face[k]] += 2.0F;
      }
    }
    for (std::size_t v = 0; v < sums.size(); ++v)
      if (counts[v] > 0.0F) mesh.vertices[v] = sums[v] / counts[v];
  }
}

TEST(FilledHoles, OfBreaksAreLeftOutAndToldAndThePiecesJoin) {
  const glm::dvec2 middle_a(-10, 5);
  const glm::dvec2 middle_b(12, -6);
  mesh::Mesh below = scanned_half(true, 5);
  mesh::Mesh above = scanned_half(false, 6);
  close_hole(below, middle_a);
  close_hole(above, middle_b);
  const Rigid away{axis_rotation(glm::normalize(glm::dvec3(1, 2, -1)), 2.1), {30, -12, 55}};
  const Context context;
  const Fragment a = prepare("a", below, context);
  const Fragment b = prepare("b", testing::moved(above, away, {3, 1, -2}), context);
  for (const Fragment* piece : {&a, &b}) {
    ASSERT_TRUE(piece->open);
    ASSERT_FALSE(piece->warnings.empty());
    EXPECT_NE(piece->warnings.front().find("closes holes"), std::string::npos) << piece->warnings.front();
  }
  std::size_t inside = 0;
  for (const glm::vec3& p : a.facets.samples.points)
    if (in_hole(glm::vec3(a.surface.origin + glm::dvec3(p)), middle_a)) ++inside;
  // The outermost two rings of the membrane are as rough as what lies beside them.
  EXPECT_LT(static_cast<double>(inside) * a.facets.sample_area, 0.2 * M_PI * kRadius * kRadius);
  const Result result = match(a, b, Options{}, context);
  ASSERT_FALSE(result.candidates.empty());
  const Rigid off = result.candidates[0].pose * away;
  EXPECT_LT(angle_between(off, Rigid{}), 0.5 * kDegree);
  EXPECT_LT(glm::length(off(glm::dvec3(0.0))), 0.2);
  EXPECT_EQ(result.verdict, Verdict::Join);
}

mesh::Mesh slab() {
  mesh::Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back(110 * (corner & 1), 80 * (corner >> 1 & 1), 24 * (corner >> 2));
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// With less of its breaks a piece has more of its surface in parallel faces, as sherds have.
TEST(FilledHoles, LeftOutOfASolidPieceMakeNoSherdOfIt) {
  shatter::Options options;
  options.pieces = 6;
  options.seed = 3;
  options.noise = 0.0003;
  options.spacing = 0.007;
  const Context context;
  const shatter::Shattered seen = shatter::shatter("slab", slab(), options, context);
  options.closed = 0.3;
  const shatter::Shattered closed = shatter::shatter("slab", slab(), options, context);
  for (std::size_t k = 0; k < closed.pieces.size(); ++k) {
    const Fragment whole = prepare("whole", seen.pieces[k].scan, context);
    const Fragment holed = prepare("holed", closed.pieces[k].scan, context);
    EXPECT_TRUE(holed.open) << k;
    EXPECT_EQ(whole.facets.wall_thickness > 0.0, holed.facets.wall_thickness > 0.0) << k;
  }
}

}  // namespace
}  // namespace rejoin::match
