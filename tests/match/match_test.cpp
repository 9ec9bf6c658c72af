#include "match/match.hpp"
#include "core/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../mesh/facet_shapes.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "mesh/load.hpp"
#include "mesh/point_index.hpp"
#include "mesh/surface.hpp"
#include "prepared_pair.hpp"

namespace rejoin::match {
namespace {

using testing::make_pair;
using testing::Pair;

TEST(Match, FindsThePlantedCut) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Pair pair = make_pair(seed);
    const Result result = match(pair.a, pair.b, Options{}, Context{});
    ASSERT_FALSE(result.candidates.empty());
    EXPECT_LT(angle_between(result.candidates.front().pose, pair.planted.truth), 1.0 * kDegree)
        << "seed " << seed;
    EXPECT_EQ(result.verdict, Verdict::Join) << "seed " << seed;
    EXPECT_GT(result.evaluations, 1000);
  }
}

TEST(Prepare, TellsOfAMeshTooCoarseForItsWall) {
  const std::string path = std::string(REJOIN_SOURCE_DIR) + "/meshes/bowl/a.drc";
  const mesh::Mesh scan = mesh::load(path).mesh;
  EXPECT_TRUE(prepare("fine", scan, Context{}).warnings.empty());
  const Fragment coarse = prepare("coarse", mesh::simplify(scan, 2000), Context{});
  ASSERT_EQ(coarse.warnings.size(), 1U);
  EXPECT_NE(coarse.warnings[0].find("coarse: its mesh has "), std::string::npos) << coarse.warnings[0];
}

TEST(Prepare, ExpectsFineEdgesOfBreaksAlone) {
  // Triangles of 2.6 mm on the sides, of 0.8 mm on the breaks, five of them across.
  mesh::Mesh plate = mesh::test::box({60, 40, 4}, 20, mesh::test::flat);
  for (glm::vec3& p : plate.vertices) p.z += 0.004F * (p.x - 30.0F) * (p.x - 30.0F);  // or it is a table's
  const Fragment fragment = prepare("plate", plate, Context{});
  ASSERT_NEAR(fragment.facets.wall_thickness, 4.0, 0.1);
  EXPECT_TRUE(fragment.warnings.empty()) << fragment.warnings[0];
}

/// Share of the samples that are classed as the nearest ones of another scan of the same piece are.
double alike(const mesh::Segmentation& scan, const mesh::Segmentation& other) {
  const mesh::PointIndex index(other.samples.points);
  std::size_t count = 0;
  for (std::size_t i = 0; i < scan.samples.size(); ++i)
    count += scan.surface[i] == other.surface[index.nearest(scan.samples.points[i])->first] ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(scan.samples.size());
}

TEST(Prepare, TellsBreaksFromWallsInANoisyScan) {
  mesh::Mesh scan = mesh::load(std::string(REJOIN_SOURCE_DIR) + "/meshes/bowl/a.drc").mesh;
  const Fragment clean = prepare("clean", scan, Context{});
  EXPECT_EQ(clean.noise_left, 0.0);
  Random random(7);
  for (glm::vec3& v : scan.vertices)
    v += glm::vec3(glm::dvec3(random.normal(), random.normal(), random.normal()) * 0.3 * clean.resolution);
  const Fragment noisy = prepare("noisy", scan, Context{});
  EXPECT_EQ(noisy.surface.vertices, scan.vertices);  // what is written and shown is the scan
  EXPECT_GT(noisy.noise_left, 0.0);
  EXPECT_GT(alike(noisy.facets, clean.facets), 0.93);
}

TEST(Prepare, TellsOfAScanFromOneSideThatIsTakenForASolidPiece) {
  const mesh::Mesh block = testing::half_block(false, 48);
  EXPECT_TRUE(prepare("whole", block, Context{}).warnings.empty());
  mesh::Mesh seen = block;
  std::erase_if(seen.faces, [&](const glm::uvec3& f) {
    const glm::vec3 a = block.vertices[f.x];
    return glm::dot(glm::cross(block.vertices[f.y] - a, block.vertices[f.z] - a), glm::vec3(0, 0, -1)) <= 0;
  });
  const Fragment cut = prepare("cut", seen, Context{});
  ASSERT_EQ(cut.warnings.size(), 1U);
  EXPECT_NE(cut.warnings[0].find("cut: nothing lies behind "), std::string::npos) << cut.warnings[0];
}

TEST(Prepare, TellsOfTwoBodiesAndOfATable) {
  const mesh::Mesh block = testing::half_block(false, 48);
  const mesh::Box box = mesh::bounds(block);
  mesh::Mesh two = block;
  const auto first = static_cast<std::uint32_t>(block.vertices.size());
  for (const glm::vec3& v : block.vertices) two.vertices.push_back(v + 1.2F * (box.high - box.low));
  for (const glm::uvec3& face : block.faces) two.faces.push_back(face + first);
  const Fragment several = prepare("two", two, Context{});
  ASSERT_EQ(several.warnings.size(), 1U);
  EXPECT_EQ(several.warnings[0].find("two: holds 2 bodies (50 %, 50 % of its area)"), 0U)
      << several.warnings[0];
  EXPECT_NE(several.warnings[0].find("rejoin split"), std::string::npos) << several.warnings[0];

  mesh::Mesh standing = block;
  const float far = 2.0F * glm::distance(box.low, box.high);
  for (const glm::vec2& corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
    standing.vertices.emplace_back(far * corner, box.low.z);
  standing.faces.emplace_back(first, first + 1, first + 2);
  standing.faces.emplace_back(first, first + 2, first + 3);
  const Fragment table = prepare("table", standing, Context{});
  EXPECT_EQ(std::ranges::count_if(table.warnings,
                                  [](const std::string& text) {
                                    return text.find("is a plane, as a table") != std::string::npos &&
                                           text.find("rejoin split") != std::string::npos;
                                  }),
            1);
}

TEST(Match, PlainBlockDoesNotJoin) {
  // Flat sides of equal size everywhere, nothing that fits the cut: the paper's trivial solutions must not count.
  const Pair pair = make_pair(4);
  mesh::Mesh plain = testing::half_block(false, 48);
  for (auto& v : plain.vertices) {
    if (v.z < static_cast<float>(testing::kHalfZ)) v.z = -10.0F;
  }
  const Fragment other = prepare("plain", plain, Context{});
  const Result result = match(pair.a, other, Options{}, Context{});
  EXPECT_EQ(result.verdict, Verdict::NoJoin);
}

/// A scan of one half of a block by a scanner that puts every point off by 0.35 mm along every axis.
Fragment noisy_half(mesh::Mesh half, std::uint64_t seed) {
  Random random(seed);
  for (auto& v : half.vertices) {
    v += glm::vec3(0.35 * glm::dvec3(random.normal(), random.normal(), random.normal()));
  }
  return prepare("noisy " + std::to_string(seed), std::move(half), Context{});
}

TEST(Match, NoisyScansJoinWhereTheirBreaksFitAsWellAsNoiseLetsThem) {
  const auto planted = testing::planted_pair(7, 96);
  const Fragment a = noisy_half(planted.a, 1);
  const Fragment b = noisy_half(planted.b, 2);
  ASSERT_LT(0.3 * a.resolution, 0.35);  // what the spacing of the points alone would let touch
  const Result result = match(a, b, Options{}, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_LT(angle_between(result.candidates.front().pose, planted.truth), 1.0 * kDegree);
  EXPECT_EQ(result.verdict, Verdict::Join);
}

TEST(Match, NoiseIsNoReliefToAgreeOn) {
  mesh::Mesh flat = testing::half_block(false, 96);
  for (auto& v : flat.vertices) {
    if (v.z < static_cast<float>(testing::kHalfZ)) v.z = -10.0F;
  }
  const Fragment a = noisy_half(flat, 3);
  const Fragment b = noisy_half(flat, 4);
  EXPECT_EQ(match(a, b, Options{}, Context{}).verdict, Verdict::NoJoin);
}

TEST(Match, ThreadsDoNotChangeTheResult) {
  const Pair pair = make_pair(6);
  std::vector<Result> results;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    results.push_back(match(pair.a, pair.b, Options{}, Context{}));
  }
  ASSERT_EQ(results[0].candidates.size(), results[1].candidates.size());
  for (std::size_t k = 0; k < results[0].candidates.size(); ++k) {
    EXPECT_EQ(results[0].candidates[k].score, results[1].candidates[k].score);
    EXPECT_EQ(results[0].candidates[k].pose.translation, results[1].candidates[k].pose.translation);
  }
}

TEST(Match, AsksForDirectionsAndLooksNowhereElse) {
  const Pair pair = make_pair(7);
  Options options;
  options.constraint = Constraint::Direction;
  options.directions_a = {pair.planted.direction_a};
  options.directions_b = {pair.planted.direction_b};
  const Result narrow = match(pair.a, pair.b, options, Context{});
  const Result wide = match(pair.a, pair.b, Options{}, Context{});
  ASSERT_FALSE(narrow.candidates.empty());
  EXPECT_LT(angle_between(narrow.candidates.front().pose, pair.planted.truth), 1.0 * kDegree);
  EXPECT_LT(narrow.evaluations, wide.evaluations);
}

// The walls of a sherd join nothing.
TEST(Match, LeavesOutAndTellsWhatTheAlignmentTurnedOffTheMaterialsAxes) {
  const Pair pair = make_pair(2);
  const glm::dvec3 axis(0, 0, 1);
  Options options;
  options.constraint = Constraint::Material;
  options.material_b = axis;
  options.material_a = pair.planted.truth.rotation * axis;
  options.tolerance_deg = 4.0;
  const Result agreeing = match(pair.a, pair.b, options, Context{});
  EXPECT_EQ(agreeing.verdict, Verdict::Join);
  // Off by more than the tolerance, but not by what the search allows for.
  const glm::dvec3 across = glm::normalize(glm::cross(*options.material_a, glm::dvec3(0.3, 0.5, 0.8)));
  options.material_a = axis_rotation(across, 7.0 * kDegree) * *options.material_a;
  const Result off = match(pair.a, pair.b, options, Context{});
  EXPECT_EQ(off.verdict, Verdict::NoJoin);
  for (const Candidate& candidate : off.candidates)
    EXPECT_GT(angle_between(candidate.pose, pair.planted.truth), 2.0 * kDegree);
  EXPECT_TRUE(std::ranges::any_of(off.warnings, [](const std::string& warning) {
    return warning.find("the material's axes are more than 4 degrees off each other") != std::string::npos;
  }));
}

/// The paper's annealing, quick.
Options annealing() {
  Options options;
  options.search = Search::Esa;
  options.resolution = 48;
  options.chains = 2;
  return options;
}

TEST(Match, LeavesOutWhatTheAlignmentTurnedOffTheAxesThatRestrictTheAnnealing) {
  const Pair pair = make_pair(2);
  Options options = annealing();
  options.constraint = Constraint::Material;
  options.material_a = glm::dvec3(0, 0, 1);
  options.material_b = glm::dvec3(0, 0, 1);
  std::size_t count = 0;
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    const Result result = match(pair.a, pair.b, options, Context{});
    count += result.candidates.size();
    for (const Candidate& candidate : result.candidates)
      EXPECT_GE(std::abs(candidate.pose.rotation[2].z), std::cos(options.tolerance_deg * kDegree));
  }
  EXPECT_GT(count, 0U);
}

TEST(Match, TellsOfWallsThatAreAskedFor) {
  const auto thin_half = [](bool below) {
    mesh::Mesh half = testing::half_block(below, 64);
    for (auto& v : half.vertices) v.y *= 0.12F;
    return prepare(below ? "below" : "above", half, Context{});
  };
  const Fragment below = thin_half(true);
  const Fragment above = thin_half(false);
  const auto& facets = below.facets.facets;
  const auto wall = std::ranges::find_if(facets, [](const mesh::Facet& facet) { return !facet.fracture; });
  ASSERT_NE(wall, facets.end());
  for (Options options : {Options{}, annealing()}) {
    options.facets_a = {static_cast<int>(wall - facets.begin())};
    const Result of_facet = match(below, above, options, Context{});
    ASSERT_FALSE(of_facet.warnings.empty()) << "search " << static_cast<int>(options.search);
    EXPECT_NE(of_facet.warnings[0].find("is original surface"), std::string::npos) << of_facet.warnings[0];
  }
}

// The sides of this block face along the axes, so its corners' direction lies 55 degrees from the closest.
TEST(Match, TellsOfADirectionThatNoFacetFaces) {
  const Fragment below = prepare("below", testing::half_block(true, 48), Context{});
  const Fragment above = prepare("above", testing::half_block(false, 48), Context{});
  for (Options options : {Options{}, annealing()}) {
    options.constraint = Constraint::Direction;
    options.directions_a = {{0, 0, 1}};
    EXPECT_TRUE(match(below, above, options, Context{}).warnings.empty());
    options.directions_a = {{1, 1, -1}};
    const Result result = match(below, above, options, Context{});
    ASSERT_EQ(result.warnings.size(), 1U) << "search " << static_cast<int>(options.search);
    EXPECT_NE(result.warnings[0].find("below: no break faces 1,1,-1; the closest one is 55 degrees off"),
              std::string::npos)
        << result.warnings[0];
  }
}

TEST(Match, CancelledSearchReturnsAtOnceAndSaysSo) {
  const Pair pair = make_pair(8);
  Context context;
  context.cancel();
  const Result result = match(pair.a, pair.b, Options{}, context);
  EXPECT_TRUE(result.cancelled);
}

TEST(Match, PosesAlongWhichOnePieceSlidesAreNoJoins) {
  const Fragment below = testing::grooved_half(true);
  const Fragment above = testing::grooved_half(false);
  Options options;
  options.near = Rigid{};
  const Result result = match(below, above, options, Context{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_TRUE(result.candidates.front().slides);
  EXPECT_LE(result.candidates.front().score, 0.5 + 1e-9);
  EXPECT_NE(result.against.find("slides"), std::string::npos) << result.against;
}

}  // namespace
}  // namespace rejoin::match
