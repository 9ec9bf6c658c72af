#include <gtest/gtest.h>

#include "../mesh/sponge.hpp"
#include "core/angle.hpp"
#include "match/detail/joint_sides.hpp"
#include "match/match.hpp"
#include "mesh/point_index.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

/// Heights of a break across the slab, along x.
double broken_at(const glm::dvec3& p) {
  return 1.2 * std::sin(0.21 * p.y + 0.1 * p.z) + 0.5 * std::sin(0.45 * p.y - 0.3 * p.z + 1.0) +
         0.25 * std::sin(1.1 * p.y + 0.5 * p.z + 0.4);
}

mesh::Mesh moved(const mesh::Mesh& mesh, const Rigid& pose) {
  mesh::Mesh out = mesh;
  out.origin = glm::dvec3(0.0);
  for (glm::vec3& v : out.vertices) v = glm::vec3(pose(mesh.origin + glm::dvec3(v)));
  return out;
}

// Cells lie open on both sides of the break, at the same places.
TEST(Sponge, BrokenAcrossItsCellsJoins) {
  const mesh::Mesh left = mesh::test::sponge_where([](const glm::dvec3& p) { return p.x - broken_at(p); });
  const mesh::Mesh right = mesh::test::sponge_where([](const glm::dvec3& p) { return broken_at(p) - p.x; });
  const Rigid away{axis_rotation(glm::normalize(glm::dvec3(1, 2, -1)), 2.1), {30, -12, 55}};
  const Context context;
  const Fragment a = prepare("a", left, context);
  const Fragment b = prepare("b", moved(right, away), context);
  EXPECT_NEAR(a.facets.wall_thickness, mesh::test::kSpongeSize.z, 0.2);
  ASSERT_FALSE(a.warnings.empty());
  EXPECT_NE(a.warnings.front().find("pores"), std::string::npos) << a.warnings.front();
  const Result result = match(a, b, Options{}, context);
  ASSERT_FALSE(result.candidates.empty());
  const Rigid off = result.candidates[0].pose * away;
  EXPECT_LT(angle_between(off, Rigid{}), 1.0 * kDegree);
  EXPECT_LT(glm::length(off(glm::dvec3(0.0))), 0.2);
  EXPECT_EQ(result.verdict, Verdict::Join);
}

// A solid piece with samples far apart for its size is sampled more densely when it is judged.
TEST(Sponge, NoSampleByWhichAJointIsJudgedLiesInAPore) {
  const mesh::Mesh left = mesh::test::sponge_where([](const glm::dvec3& p) { return p.x - broken_at(p); });
  const Fragment a = prepare("a", left, Context(), mesh::PieceKind::Solid);
  ASSERT_TRUE(a.open);
  const detail::JointSides sides(a, a);
  ASSERT_GT(sides.a().body.points.size(), a.facets.samples.size());
  const mesh::PointIndex open(a.facets.samples.points);
  std::size_t farther = 0;
  for (const glm::vec3& point : sides.a().body.points)
    if (open.nearest(point)->second > a.facets.samples.spacing) ++farther;
  EXPECT_LT(farther, sides.a().body.points.size() / 100);
}

}  // namespace
}  // namespace rejoin::match
