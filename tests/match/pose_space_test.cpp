#include "match/pose_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "planted_block.hpp"
#include "zbuffer/error.hpp"

namespace rejoin::match {
namespace {

void expect_near(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
  EXPECT_LE(glm::length(got - wanted), tolerance)
      << "(" << got.x << ", " << got.y << ", " << got.z << ") is not (" << wanted.x << ", " << wanted.y
      << ", " << wanted.z << ")";
}

glm::dvec3 turned(const glm::mat3& rotation, const glm::dvec3& v) {
  return glm::dmat3(rotation) * v;
}

PoseVector pose_with(std::initializer_list<std::pair<PoseIndex, double>> values) {
  PoseVector pose{};
  for (const auto& [index, value] : values) pose[index] = value;
  return pose;
}

TEST(PoseSpace, GeneralOrderTurnsAboutYThenXThenZ) {
  const double q = std::numbers::pi / 2;
  const auto pose = pose_with({{kTheta1, q}, {kPhi1, q}, {kRho1, q}, {kX1, 3}, {kY1, -4}});
  const auto view = view_of(pose, {}, RotationOrder::ZLast);
  // x -> (Ry) -z -> (Rx) y -> (Rz) -x, and so on round.
  expect_near(turned(view.rotation_a, {1, 0, 0}), {-1, 0, 0}, 1e-6);
  expect_near(turned(view.rotation_a, {0, 1, 0}), {0, 0, 1}, 1e-6);
  expect_near(turned(view.rotation_a, {0, 0, 1}), {0, 1, 0}, 1e-6);
  EXPECT_EQ(view.shift_a, glm::vec2(3, -4));
}

TEST(PoseSpace, MaterialOrderTurnsAboutZFirst) {
  const double q = std::numbers::pi / 2;
  const auto pose = pose_with({{kTheta1, q}, {kPhi1, q}, {kRho1, q}});
  const auto view = view_of(pose, {}, RotationOrder::ZFirst);
  // x -> (Rz) y -> (Ry) y -> (Rx) z
  expect_near(turned(view.rotation_a, {1, 0, 0}), {0, 0, 1}, 1e-6);
  // z -> (Rz) z -> (Ry) x -> (Rx) x: rho does not move the material axis.
  expect_near(turned(view.rotation_a, {0, 0, 1}), {1, 0, 0}, 1e-6);
}

TEST(PoseSpace, SecondFragmentTurnsAboutYThenX) {
  const double q = std::numbers::pi / 2;
  const auto view = view_of(pose_with({{kTheta2, q}, {kPhi2, q}}), {}, RotationOrder::ZLast);
  expect_near(turned(view.rotation_b, {1, 0, 0}), {0, 1, 0}, 1e-6);
  expect_near(turned(view.rotation_b, {0, 1, 0}), {0, 0, 1}, 1e-6);
}

TEST(PoseSpace, AlignmentComesBeforeThePoseAndItsShiftIsAdded) {
  Alignment alignment;
  alignment.rotation_a = rotation_between(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1));
  alignment.shift_a = {10, 20};
  const auto view = view_of(pose_with({{kRho1, 1.0}, {kX1, 1}, {kY1, 2}}), alignment, RotationOrder::ZLast);
  expect_near(turned(view.rotation_a, {1, 0, 0}), {0, 0, 1}, 1e-6);
  EXPECT_EQ(view.shift_a, glm::vec2(11, 22));
}

TEST(PoseSpace, IdentityViewPutsBFaceToFaceAtTheOffset) {
  const ViewCentres centres{{100, 0, 0}, {0, 50, 0}};
  const Rigid pose = pose_of({}, 7, centres);
  expect_near(pose({0, 50, 0}), {100, 0, 7}, 1e-12);
  expect_near(pose({1, 52, 3}), {99, 2, 4}, 1e-12);  // x and z turn round, y stays
}

TEST(PoseSpace, ShiftOfAMovesBTheOtherWay) {
  zbuffer::ViewPair view;
  view.shift_a = {2, 3};
  expect_near(pose_of(view, 0, {})({0, 0, 0}), {-2, -3, 0}, 1e-12);
}

TEST(PoseSpace, FacingViewIsTheInverseOfPoseOf) {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const Rigid pose = testing::random_rigid(random, 100);
    const ViewCentres centres{{1000, random.uniform(-9, 9), -3}, {random.uniform(-9, 9), 7, 2000}};
    const auto direction = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
    const FacingView facing = facing_view(pose, direction, centres);
    expect_near(turned(facing.view.rotation_a, direction), {0, 0, 1}, 1e-6);
    const Rigid back = pose_of(facing.view, facing.offset, centres);
    EXPECT_LT(angle_between(back, pose), 1e-5);  // the view holds floats
    expect_near(back(centres.b), pose(centres.b), 1e-3);
  }
}

TEST(PoseSpace, PoseIsOrthonormalToDoublePrecision) {
  const auto view = view_of(pose_with({{kTheta1, 1}, {kPhi1, 2}, {kRho1, 3}, {kTheta2, 4}, {kPhi2, 5}}), {},
                            RotationOrder::ZLast);
  const glm::dmat3 r = pose_of(view, 1, {}).rotation;
  const glm::dmat3 product = glm::transpose(r) * r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(product[i][j], i == j ? 1.0 : 0.0, 1e-14);
  }
  EXPECT_NEAR(glm::determinant(r), 1.0, 1e-14);
}

TEST(PoseSpace, ViewCentreIsTheMiddleOfABoxWhateverItsSampling) {
  mesh::Mesh box;
  for (const float x : {0.0F, 10.0F}) {
    for (const float y : {0.0F, 4.0F}) {
      for (const float z : {0.0F, 2.0F}) box.vertices.emplace_back(x, y, z);
    }
  }
  for (int k = 0; k < 500; ++k) box.vertices.emplace_back(0.01F * static_cast<float>(k % 10), 1, 1);
  expect_near(view_centre(box), {5, 2, 1}, 0.06);  // 1 % of the radius
}

TEST(PoseSpace, ViewCubeHoldsTheFragmentAtEveryRotation) {
  // A regular tetrahedron is the worst case: radius 0.612 of the diameter, still below 0.65.
  mesh::Mesh tetrahedron;
  tetrahedron.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const glm::dvec3 centre = view_centre(tetrahedron);
  for (const glm::vec3& v : tetrahedron.vertices) {
    EXPECT_LT(glm::length(glm::dvec3(v) - centre), 0.65 * 2 * std::sqrt(2.0));
  }
}

// Maps of two planes: z_a = slope * x of A, and B complementary at `gap` with some pixels standing proud.
std::pair<zbuffer::DepthMap, zbuffer::DepthMap> plane_maps(double gap, int spikes) {
  constexpr int kSize = 20;
  zbuffer::DepthMap a(kSize, kSize);
  zbuffer::DepthMap b(kSize, kSize);
  for (int j = 0; j < kSize; ++j) {
    for (int i = 0; i < kSize; ++i) {
      a.at(i, j) = 50.0F - 0.5F * static_cast<float>(i);
      b.at(kSize - 1 - i, j) = 50.0F + 0.5F * static_cast<float>(i) + static_cast<float>(gap);
    }
  }
  for (int k = 0; k < spikes; ++k) a.at(k, 3) -= 10.0F;
  return {a, b};
}

TEST(Contact, ComplementaryPlanesTouchExactly) {
  const auto [a, b] = plane_maps(6, 0);
  EXPECT_NEAR(contact_offset(a, b, 100), -6, 1e-5);  // z_a + z_b = 100 - 50 - 50 - 6
}

TEST(Contact, AFewSpikesDoNotHoldTheFragmentsApart) {
  const auto [a, b] = plane_maps(6, 12);  // 3 % of the pixels
  EXPECT_NEAR(contact_offset(a, b, 100), -6, 1e-5);
  EXPECT_NEAR(contact_offset(a, b, 100, {.percentile = 1.0}), 4, 1e-5);
}

TEST(Contact, AtMostTheStatedShareOfPixelsPenetrates) {
  Random random(11);
  zbuffer::DepthMap a(30, 30);
  zbuffer::DepthMap b(30, 30);
  for (std::size_t p = 0; p < 900; ++p) {
    a.depth[p] = static_cast<float>(random.uniform(20, 60));
    b.depth[p] = static_cast<float>(random.uniform(20, 60));
  }
  const double offset = contact_offset(a, b, 100, {.percentile = 0.9});
  int deep = 0;
  for (int j = 0; j < 30; ++j) {
    for (int i = 0; i < 30; ++i) deep += 100.0 - a.at(i, j) - b.at(29 - i, j) > offset ? 1 : 0;
  }
  EXPECT_LE(deep, 91);
  EXPECT_GE(deep, 85);
}

TEST(Contact, MapsThatDoNotOverlapStandApart) {
  zbuffer::DepthMap a(8, 8);
  zbuffer::DepthMap b(8, 8);
  a.at(1, 1) = 5;
  b.at(1, 1) = 5;  // mirrored: column 6
  EXPECT_EQ(contact_offset(a, b, 100), 100);
  EXPECT_THROW(contact_offset(a, zbuffer::DepthMap(8, 9), 100), InputError);
}

class PlantedCut : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(PlantedCut, ExactViewGivesTheTruePoseBack) {
  const auto pair = testing::planted_pair(GetParam());
  zbuffer::ViewOptions options;
  options.centre_a = glm::vec3(view_centre(pair.a));
  options.centre_b = glm::vec3(view_centre(pair.b));
  options.view_side = 1.3 * std::max(mesh::diameter(pair.a), mesh::diameter(pair.b));
  const ViewCentres centres{pair.a.origin + glm::dvec3(options.centre_a),
                            pair.b.origin + glm::dvec3(options.centre_b)};
  const auto scorer = zbuffer::make_scorer(zbuffer::Backend::Raster, pair.a, pair.b, options);
  const FacingView facing = facing_view(pair.truth, pair.direction_a, centres);
  const auto [a, b] = scorer->depth_maps(facing.view);
  const double pixel = options.view_side / options.resolution;

  // The mirrored maps are complementary: hardly any slope difference, full overlap.
  const zbuffer::PairScore score = zbuffer::slope_difference(a, b, options.view_side);
  EXPECT_LT(score.error * options.resolution, 0.02);
  EXPECT_GT(score.overlap, 0.97 * std::min(score.covered_a, score.covered_b));

  const Rigid pose = pose_of(facing.view, contact_offset(a, b, options.view_side), centres);
  EXPECT_LT(angle_between(pose, pair.truth), 1e-4);
  // The rotation and shift were given; along Z the triangles' chords may differ by far less than a pixel.
  EXPECT_LT(glm::length(pose(centres.b) - pair.truth(centres.b)), 0.1 * pixel);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlantedCut, ::testing::Values(1, 2, 3, 4, 5));

}  // namespace
}  // namespace rejoin::match
