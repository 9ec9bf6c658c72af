/// --solid: a slab that is split in its plane, whose halves look like two sherds.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../match/planted_block.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::json;

/// Half of a slab 12 mm thick; its break has a quarter of the block's relief.
mesh::Mesh half_slab(bool below) {
  constexpr float kHalf = 6;
  mesh::Mesh half = match::testing::half_block(below, 60);
  for (glm::vec3& v : half.vertices)
    v.z =
        std::abs(v.z) == static_cast<float>(match::testing::kHalfZ) ? std::copysign(kHalf, v.z) : 0.25F * v.z;
  return half;
}

class SplitSlab : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(scans_);
    Random random(11);
    const Rigid to_a = match::testing::random_rigid(random, 100);
    const Rigid to_b = match::testing::random_rigid(random, 100);
    mesh::save(a_, match::testing::moved(half_slab(true), to_a, {3, -2, 1}));
    mesh::save(b_, match::testing::moved(half_slab(false), to_b, {-4, 5, 2}));
    truth_ = to_a * inverse(to_b);
  }

  json written(std::vector<std::string> words) const {
    words.insert(words.end(), {"--json", json_});
    const Finished finished = run(words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return json::parse(read_file(json_));
  }

  /// How far the middle of B's place lies off its true one, mm.
  double off(const json& pose) const {
    const glm::dvec3 middle = inverse(truth_)(glm::dvec3(0));
    const glm::dvec3 there = truth_(middle);
    glm::dvec3 here(0.0);
    for (int row = 0; row < 3; ++row) {
      here[row] = pose[row][3];
      for (int column = 0; column < 3; ++column)
        here[row] += pose[row][column].get<double>() * middle[column];
    }
    return glm::distance(here, there);
  }

  const TemporaryFolder folder_;
  const std::string scans_ = folder_ / "scans";
  const std::string a_ = scans_ + "/a.ply";
  const std::string b_ = scans_ + "/b.ply";
  const std::string json_ = folder_ / "out.json";
  Rigid truth_;
};

TEST_F(SplitSlab, HasWallsUnlessTheUserSaysSo) {
  EXPECT_GT(written({"facets", a_})["wall_thickness"], 4.0);
  const json solid = written({"facets", a_, "--solid"});
  EXPECT_EQ(solid["wall_thickness"], 0.0);
  for (const json& facet : solid["facets"]) EXPECT_TRUE(facet["fracture"]) << facet;
}

TEST_F(SplitSlab, IsMatchedAndComparedByItsFaces) {
  EXPECT_NE(written({"match", a_, b_})["verdict"], "join") << "else nothing is asked of --solid";
  const json found = written({"match", a_, b_, "--solid"});
  EXPECT_EQ(found["verdict"], "join");
  EXPECT_LT(off(found["pose"]), 0.5);
  const std::string pose = folder_ / "pose.json";
  write_file(pose, found.dump());
  const json compared = written({"compare", a_, b_, "--pose", pose, "--steps", "0", "--solid"});
  EXPECT_GT(compared["joint"]["score"], 0.99);
}

TEST_F(SplitSlab, IsPutTogetherFromARunThatKnowsIt) {
  const std::string out = folder_ / "run";
  ASSERT_EQ(run({"batch", scans_, "--out", out, "--solid"}).exit_code, 0);
  const json assembly = written({"assemble", out});
  ASSERT_EQ(assembly["joins"].size(), 1U) << assembly;
  EXPECT_GT(assembly["joins"][0]["contact"], 1000.0)
      << "of the broken faces, not of what would be walls' rims";
  const Finished again = run({"batch", scans_, "--out", out});
  EXPECT_NE(again.out.find("1 of 1 pairs done, 1 of them now"), std::string::npos) << again.out;
  EXPECT_EQ(run({"assemble", out, "--solid"}).exit_code, 2) << "the run tells it";
}

}  // namespace
}  // namespace rejoin::cli::testing
