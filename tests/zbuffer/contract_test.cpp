/// What every backend promises, whatever draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/load.hpp"
#include "mesh/surface.hpp"
#include "shapes.hpp"

namespace rejoin::zbuffer {
namespace {

constexpr int kResolution = 64;

class Contract : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    static const std::vector<BackendInfo> known = list_backends();
    const auto info = std::ranges::find(known, GetParam(), &BackendInfo::backend);
    ASSERT_NE(info, known.end());
    ASSERT_TRUE(info->available) << name_of(GetParam()) << ": " << info->why_not << "; run scripts/setup";
  }

  static std::unique_ptr<Scorer> scorer(const mesh::Mesh& a, const mesh::Mesh& b,
                                        const ViewOptions& options) {
    return make_scorer(GetParam(), a, b, options);
  }

  static PairScore score(Scorer& scorer, const ViewPair& pose) {
    PairScore result;
    scorer.score({&pose, 1}, {&result, 1});
    return result;
  }
};

bool covered(const DepthMap& map, int i, int j) {
  return i >= 0 && j >= 0 && i < map.width && j < map.height && !std::isnan(map.at(i, j));
}

/// Difference of the nearest and farthest depths in the 3 x 3 pixels around (i, j); infinite at the
/// silhouette.
float local_range(const DepthMap& map, int i, int j) {
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  for (int y = j - 1; y <= j + 1; ++y) {
    for (int x = i - 1; x <= i + 1; ++x) {
      if (!covered(map, x, y)) return std::numeric_limits<float>::infinity();
      low = std::min(low, map.at(x, y));
      high = std::max(high, map.at(x, y));
    }
  }
  return high - low;
}

TEST_P(Contract, NamesItself) {
  const mesh::Mesh sphere = test::icosphere(1, 1);
  const auto s = scorer(sphere, sphere, {.resolution = 16});
  EXPECT_EQ(s->backend(), GetParam());
  EXPECT_FALSE(s->renderer().empty());
}

TEST_P(Contract, SphereHasItsAnalyticDepths) {
  const float r = 0.8F;
  const double side = 2.0;
  const ViewOptions options{.resolution = kResolution, .view_side = side, .centre_b = {0.1F, 0, 0}};
  const ViewPair pose{
      .rotation_a = test::about_x(0.4), .shift_a = {0.15F, -0.1F}, .rotation_b = test::about_y(-1.0)};
  const auto maps = scorer(test::icosphere(r, 4), test::icosphere(r, 4), options)->depth_maps(pose);
  const glm::dvec3 centre_b = glm::dmat3(pose.rotation_b) * glm::dvec3(-0.1, 0, 0);
  const std::pair<const DepthMap*, glm::dvec3> cases[] = {{&maps.first, {0.15, -0.1, 0}},
                                                          {&maps.second, centre_b}};
  const double pitch = side / kResolution;
  for (const auto& [map, centre] : cases) {
    for (int j = 0; j < kResolution; ++j) {
      for (int i = 0; i < kResolution; ++i) {
        const double x = (i + 0.5) * pitch - side / 2 - centre.x;
        const double y = (j + 0.5) * pitch - side / 2 - centre.y;
        const double off_axis = std::hypot(x, y);
        if (off_axis < r - pitch) {
          ASSERT_TRUE(covered(*map, i, j)) << i << ", " << j;
        }
        if (off_axis > r + pitch) {
          ASSERT_FALSE(covered(*map, i, j)) << i << ", " << j;
        }
        if (off_axis < 0.8 * r) {
          // The faces cut up to 1e-3 r into the sphere, more by 1 / cos(53 deg) along the axis.
          ASSERT_NEAR(map->at(i, j), side / 2 - centre.z - std::sqrt(r * r - off_axis * off_axis), 2e-3 * r);
        }
      }
    }
  }
}

TEST_P(Contract, TiltedPlaneHasItsAnalyticDepths) {
  const double side = 3.0;
  const double tilt = 0.5;
  const mesh::Mesh square = test::height_field(1.0F, 3, [](float, float) { return 0.0F; });
  const auto map = scorer(square, square, {.resolution = kResolution, .view_side = side})
                       ->depth_maps({.rotation_a = test::about_y(tilt)})
                       .first;
  const double pitch = side / kResolution;
  for (int j = 0; j < kResolution; ++j) {
    for (int i = 0; i < kResolution; ++i) {
      const double x = (i + 0.5) * pitch - side / 2;
      const double y = (j + 0.5) * pitch - side / 2;
      const bool inside = std::abs(x) < std::cos(tilt) - pitch && std::abs(y) < 1.0 - pitch;
      const bool outside = std::abs(x) > std::cos(tilt) + pitch || std::abs(y) > 1.0 + pitch;
      if (inside) {
        ASSERT_TRUE(covered(map, i, j));
      }
      if (outside) {
        ASSERT_FALSE(covered(map, i, j));
      }
      // Corners may be moved to a grid of 1/256 pixel (GL's least), so depths by that times the slope.
      if (covered(map, i, j)) {
        ASSERT_NEAR(map.at(i, j), side / 2 + x * std::tan(tilt), pitch / 256 + 1e-6 * side);
      }
    }
  }
}

TEST_P(Contract, TiltedPlanesDifferByTheirSlopes) {
  const mesh::Mesh square = test::height_field(1.0F, 1, [](float, float) { return 0.0F; });
  const auto s = scorer(square, square, {.resolution = kResolution, .view_side = 3.0});
  for (const auto& [alpha, beta] : {std::pair{0.3, 0.1}, std::pair{-0.2, 0.4}, std::pair{0.25, 0.25}}) {
    // About Y the mirror turns B's slope round, about X it does not.
    const double u = std::abs(std::tan(alpha) - std::tan(beta)) / kResolution;
    const double v = std::abs(std::tan(alpha) + std::tan(beta)) / kResolution;
    const PairScore about_y =
        score(*s, {.rotation_a = test::about_y(alpha), .rotation_b = test::about_y(beta)});
    const PairScore about_x =
        score(*s, {.rotation_a = test::about_x(alpha), .rotation_b = test::about_x(beta)});
    EXPECT_NEAR(about_y.error, u,
                1e-5);  // the plane's depths are linear: only rounding and 1/256 pixel are left
    EXPECT_NEAR(about_x.error, v, 1e-5);
    EXPECT_GT(about_y.overlap, 1000);
  }
}

TEST_P(Contract, StepHasItsAnalyticError) {
  const double side = 3.0;
  const float rise = 0.25F;
  const mesh::Mesh flat = test::height_field(1.0F, 1, [](float, float) { return 0.0F; });
  const auto s = scorer(test::step(1.0F, rise), flat, {.resolution = kResolution, .view_side = side});
  const auto map = s->depth_maps({}).first;
  EXPECT_NEAR(map.at(kResolution / 2 - 1, kResolution / 2), side / 2 + rise, 1e-6 * side);
  EXPECT_NEAR(map.at(kResolution / 2, kResolution / 2), side / 2 - rise, 1e-6 * side);
  const PairScore result = score(*s, {});
  // Pixels -20.83 .. 20.83 from the middle are covered: 42 a side (21.33 a unit), of which 41 have their
  // neighbours; one a row looks across the step.
  EXPECT_EQ(result.overlap, 41 * 41);
  EXPECT_EQ(result.covered_a, 41 * 41);
  EXPECT_EQ(result.covered_b, 41 * 41);
  EXPECT_NEAR(result.error, 2 * rise / 41 / side, 1e-6);
}

TEST_P(Contract, ComplementarySurfacesGiveNoError) {
  const auto relief = [](float x, float y) {
    return 0.2F * std::sin(5 * x + 1) * std::cos(4 * y) + 0.1F * x;
  };
  const mesh::Mesh a = test::height_field(1.0F, 40, relief);
  const auto s = scorer(a, test::turned_round(a), {.resolution = kResolution, .view_side = 3.0});
  const PairScore right = score(*s, {});
  EXPECT_LT(right.error * kResolution,
            1e-3);  // as a slope; corners on a grid of 1/256 pixel move slopes of 1 by about that
  EXPECT_NEAR(overlap_bias(right), 1.0, 0.05);
  const PairScore wrong = score(*s, {.shift_a = {0.2F, 0.0F}});
  EXPECT_GT(wrong.error, 20 * right.error);
}

/// Same silhouette to a pixel's edge, same depths but at inner edges.
void expect_same_view(const DepthMap& seen, const DepthMap& truth, double view_side) {
  const double pitch = view_side / truth.width;
  int inner = 0;
  int close = 0;
  for (int j = 0; j < truth.height; ++j) {
    for (int i = 0; i < truth.width; ++i) {
      const float range = local_range(truth, i, j);
      if (std::isinf(range)) {
        bool edge = covered(seen, i, j) == covered(truth, i, j);
        for (int k = 0; k < 9; ++k) edge = edge || covered(truth, i + k % 3 - 1, j + k / 3 - 1);
        ASSERT_TRUE(edge) << "silhouette off by more than a pixel at " << i << ", " << j;
        continue;
      }
      ASSERT_TRUE(covered(seen, i, j)) << "hole at " << i << ", " << j;
      const double off = std::abs(seen.at(i, j) - truth.at(i, j));
      ASSERT_LE(off, range + 1e-4 * view_side);  // at an inner edge either side of it may be seen
      ++inner;
      close += off < pitch / 64 ? 1 : 0;  // slopes are mostly below 4; corners move by up to 1/256 pixel
    }
  }
  EXPECT_GT(inner, 100);  // or this would show nothing; a sherd seen edge-on is narrow
  EXPECT_GT(close, 0.98 * inner);
}

void expect_same_score(const PairScore& tested, const PairScore& truth) {
  // Silhouette pixels may differ (1 % of the area); a steep pixel there carries up to 10 times the mean slope.
  EXPECT_NEAR(tested.error, truth.error, 0.02 * truth.error);
  EXPECT_NEAR(tested.overlap, truth.overlap, 0.01 * truth.overlap);
  EXPECT_NEAR(tested.covered_a, truth.covered_a, 0.01 * truth.covered_a);
  EXPECT_NEAR(tested.covered_b, truth.covered_b, 0.01 * truth.covered_b);
}

void expect_like_reference(Scorer& tested, Scorer& reference, double view_side,
                           std::span<const ViewPair> poses) {
  std::vector<PairScore> scores(poses.size());
  std::vector<PairScore> truths(poses.size());
  tested.score(poses, scores);
  reference.score(poses, truths);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    SCOPED_TRACE(testing::Message() << "pose " << k);
    const auto seen = tested.depth_maps(poses[k]);
    const auto truth = reference.depth_maps(poses[k]);
    expect_same_view(seen.first, truth.first, view_side);
    expect_same_view(seen.second, truth.second, view_side);
    expect_same_score(scores[k], truths[k]);
  }
}

TEST_P(Contract, NoisyBumpySphereIsAsInTheReference) {
  const mesh::Mesh a = test::bumpy_sphere(3, 1);
  const mesh::Mesh b = test::bumpy_sphere(3, 2);
  const ViewOptions options{.resolution = kResolution, .view_side = 2.9};
  const auto tested = scorer(a, b, options);
  const auto reference = make_scorer(Backend::Reference, a, b, options);
  expect_like_reference(*tested, *reference, options.view_side, test::random_poses(2, 21));
}

TEST_P(Contract, ScannedFragmentIsAsInTheReference) {
  static const auto sample = [](const char* name) {
    const mesh::Mesh scan = mesh::load(std::string(REJOIN_SOURCE_DIR "/meshes/bowl/") + name).mesh;
    return mesh::simplify(scan, 1500);  // the reference tests every pixel against every face
  };
  static const mesh::Mesh a = sample("a.drc");
  static const mesh::Mesh b = sample("b.drc");
  ViewOptions options{.resolution = kResolution};
  options.view_side = 1.3 * std::max(mesh::diameter(a), mesh::diameter(b));
  options.centre_a = mesh::centroid(a);
  options.centre_b = mesh::centroid(b);
  const auto tested = scorer(a, b, options);
  const auto reference = make_scorer(Backend::Reference, a, b, options);
  expect_like_reference(*tested, *reference, options.view_side, test::random_poses(2, 22));
}

TEST_P(Contract, ScoreIsTheErrorOfItsDepthMaps) {
  const mesh::Mesh a = test::bumpy_sphere(3, 3);
  const mesh::Mesh b = test::bumpy_sphere(3, 4);
  const ViewOptions options{.resolution = kResolution, .view_side = 2.9};
  const auto s = scorer(a, b, options);
  for (const ViewPair& pose : test::random_poses(2, 23)) {
    const auto maps = s->depth_maps(pose);
    const PairScore whole = score(*s, pose);
    const PairScore parts = slope_difference(maps.first, maps.second, options.view_side);
    EXPECT_NEAR(whole.error, parts.error,
                1e-3 * parts.error);  // GL may add in another order and round depths
    EXPECT_NEAR(whole.overlap, parts.overlap, 0.005 * parts.overlap);
  }
}

TEST_P(Contract, ThreadsAndSplitsDoNotChangeABit) {
  const mesh::Mesh a = test::bumpy_sphere(2, 5);
  const mesh::Mesh b = test::bumpy_sphere(2, 6);
  const auto poses = test::random_poses(13, 24);
  std::vector<PairScore> one(poses.size());
  std::vector<PairScore> many(poses.size());
  std::vector<PairScore> split(poses.size());
  const ViewOptions options{.resolution = 32};
  {
    const ThreadLimit limit(1);
    scorer(a, b, options)->score(poses, one);
  }
  const auto s = scorer(a, b, options);
  s->score(poses, many);
  const std::span<const ViewPair> all(poses);
  for (std::size_t k = 0; k < poses.size(); k += 5) {
    const std::size_t count = std::min<std::size_t>(5, poses.size() - k);
    s->score(all.subspan(k, count), std::span(split).subspan(k, count));
  }
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(PairScore)), 0);
  EXPECT_EQ(std::memcmp(one.data(), split.data(), one.size() * sizeof(PairScore)), 0);
}

TEST_P(Contract, FragmentOutOfViewHasNoOverlap) {
  const mesh::Mesh sphere = test::icosphere(0.2F, 2);
  const auto s = scorer(sphere, sphere, {.resolution = 32, .view_side = 1.0});
  const PairScore apart = score(*s, {.shift_a = {5.0F, 0.0F}});
  EXPECT_EQ(apart.overlap, 0);
  EXPECT_EQ(apart.covered_a, 0);
  EXPECT_GT(apart.covered_b, 50);
  EXPECT_EQ(apart.error, std::numeric_limits<float>::infinity());
}

TEST_P(Contract, PlacesForScoresMustMatchThePoses) {
  const mesh::Mesh sphere = test::icosphere(1, 1);
  const auto s = scorer(sphere, sphere, {.resolution = 16});
  const std::vector<ViewPair> poses(3);
  std::vector<PairScore> scores(2);
  EXPECT_THROW(s->score(poses, scores), InputError);
  EXPECT_NO_THROW(s->score({}, {}));
}

INSTANTIATE_TEST_SUITE_P(Backends, Contract,
                         testing::Values(Backend::Gpu, Backend::OsMesa, Backend::Raster, Backend::RayCast,
                                         Backend::Reference),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace rejoin::zbuffer
