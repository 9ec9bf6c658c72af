/// rejoin batch and assemble with breaks that the user painted.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "batch_runs.hpp"
#include "core/random.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class BatchFacets : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home_ = new TemporaryFolder;
    make_scans(scans());
    ASSERT_EQ(run({"batch", scans(), "--out", *home_ / "without"}).exit_code, 0);
    ASSERT_EQ(run({"facets", scans() + "/b7.ply", "--ply", *home_ / "found.ply"}).exit_code, 0);
  }
  static void TearDownTestSuite() {
    delete home_;
    home_ = nullptr;
  }

  static std::string scans() { return *home_ / "scans"; }
  static std::string without() { return *home_ / "without"; }

  void SetUp() override { fs::create_directory(painted_); }

  /// b7.ply as rejoin facets paints it, with other colours on the half that looks to the break, and on the other.
  void paint(glm::u8vec3 break_half, glm::u8vec3 other_half) const {
    const auto pair = match::testing::planted_pair(7, kCells);
    mesh::Mesh mesh = mesh::load(*home_ / "found.ply", mesh::Weld::PlacesAndColours).mesh;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const glm::dvec3 in_block = inverse(pair.to_b)(mesh.origin + glm::dvec3(mesh.vertices[v]));
      mesh.colours[v] = in_block.z < 0.7 * match::testing::kHalfZ ? break_half : other_half;
    }
    mesh::save(painted_ + "/b7-facets.ply", mesh);
  }

  Finished batch(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"batch", scans(), "--out", run_, "--facets", painted_};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  static TemporaryFolder* home_;
  const TemporaryFolder folder_;
  const std::string run_ = folder_ / "run";
  const std::string painted_ = folder_ / "painted";
  const glm::u8vec3 red_ = {250, 20, 20};
  const glm::u8vec3 grey_ = {190, 190, 190};
};
TemporaryFolder* BatchFacets::home_ = nullptr;

TEST_F(BatchFacets, BreaksArePaintedOnesAlone) {
  ASSERT_TRUE(has_the_join(without()));
  paint(grey_, red_);
  ASSERT_EQ(batch({"--thorough"}).exit_code, 0);
  EXPECT_FALSE(has_the_join(run_)) << "the back is the break";
}

TEST_F(BatchFacets, OnlyPairsOfThePaintedScanAreDoneAgain) {
  fs::copy(without(), run_, fs::copy_options::recursive);
  paint(grey_, red_);
  const Finished first = batch();
  EXPECT_NE(first.out.find("3 of 3 pairs done, 2 of them now"), std::string::npos) << first.out;
  EXPECT_NE(first.err.find("b7.ply: is painted otherwise than before;"), std::string::npos) << first.err;
  EXPECT_NE(batch().out.find(", 0 of them now"), std::string::npos);
  paint(red_, grey_);
  EXPECT_NE(batch().out.find(", 2 of them now"), std::string::npos);
  const Finished dropped = run({"batch", scans(), "--out", run_});
  EXPECT_NE(dropped.out.find(", 2 of them now"), std::string::npos) << dropped.out;
  EXPECT_EQ(read_file(run_ + "/pairs.csv"), read_file(without() + "/pairs.csv"));
}

TEST_F(BatchFacets, ShardsAreTheWholeAndThoseOfOtherPaintAreRefused) {
  paint(red_, grey_);
  ASSERT_EQ(batch().exit_code, 0);
  std::vector<std::string> merge = {"merge", "--out", folder_ / "whole"};
  const auto shard = [&](const std::string& number) {
    return run({"batch", scans(), "--out", folder_ / number, "--shard", number + "/3", "--facets", painted_});
  };
  for (const char* number : {"1", "2", "3"}) {
    merge.push_back(folder_ / number);
    ASSERT_EQ(shard(number).exit_code, 0);
  }
  ASSERT_EQ(run(merge).exit_code, 0);
  EXPECT_EQ(content(folder_ / "whole"), content(run_));
  EXPECT_EQ(run({"assemble", folder_ / "whole"}).err, run({"assemble", run_}).err);
  paint(grey_, red_);
  ASSERT_EQ(shard("3").exit_code, 0);
  const Finished refused = run(merge);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("painted otherwise"), std::string::npos) << refused.err;
}

TEST_F(BatchFacets, TheRunKeepsThem) {
  paint(red_, grey_);
  ASSERT_EQ(batch().exit_code, 0);
  fs::remove_all(painted_);
  ASSERT_EQ(run({"assemble", run_}).exit_code, 0);
  const json kept = json::parse(read_file(run_ + "/assembly.json"))["fragments"]["b7.ply"];
  EXPECT_TRUE(kept.contains("scan")) << kept;
  fs::remove_all(run_ + "/fragments");
  EXPECT_EQ(run({"assemble", run_}).exit_code, 1);
  EXPECT_EQ(json::parse(read_file(run_ + "/assembly.json"))["fragments"]["b7.ply"], kept);
  fs::remove(run_ + "/assembly.json");
  EXPECT_EQ(run({"assemble", run_}).exit_code, 1);
  const json lost = json::parse(read_file(run_ + "/assembly.json"))["fragments"]["b7.ply"];
  EXPECT_EQ(lost["reason"], "b7-facets.ply: is kept in the run no longer; run rejoin batch again");
}

TEST_F(BatchFacets, PaintWithoutABreakIsToldAndDoneAgainOnceMended) {
  paint(grey_, grey_);
  const Finished refused = batch();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("b7-facets.ply: has no break painted"), std::string::npos) << refused.err;
  EXPECT_NE(refused.out.find("3 of 3 pairs done, 3 of them now, 2 failed"), std::string::npos) << refused.out;
  paint(red_, grey_);
  const Finished mended = batch();
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
  EXPECT_NE(mended.out.find("3 of 3 pairs done, 2 of them now"), std::string::npos) << mended.out;
}

TEST_F(BatchFacets, PaintThatLiesElsewhereIsTold) {
  paint(red_, grey_);
  fs::rename(painted_ + "/b7-facets.ply", painted_ + "/a8-facets.ply");
  EXPECT_NE(batch().err.find("a8-facets.ply: does not lie on a8.ply"), std::string::npos);
}

TEST_F(BatchFacets, PaintWithoutAScanIsToldAndTheRestGoesOn) {
  paint(red_, grey_);
  fs::copy(painted_ + "/b7-facets.ply", painted_ + "/gone-facets.ply");
  const Finished finished = batch();
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("gone-facets.ply: left out, belongs to no scan"), std::string::npos)
      << finished.err;
  EXPECT_TRUE(has_the_join(run_));
}

TEST_F(BatchFacets, PaintOfTwoScansFailsWhereItDoesNotLie) {
  paint(red_, grey_);
  fs::copy(scans(), folder_ / "scans");
  mesh::save(folder_ / "scans/b7.obj", match::testing::planted_pair(9, kCells).a);
  const Finished finished = run({"batch", folder_ / "scans", "--out", run_, "--facets", painted_});
  EXPECT_EQ(finished.exit_code, 1) << finished.err;
  EXPECT_NE(finished.err.find("b7-facets.ply: is used for b7.obj and b7.ply"), std::string::npos)
      << finished.err;
  EXPECT_NE(finished.err.find("does not lie on b7.obj"), std::string::npos) << finished.err;
  EXPECT_TRUE(has_the_join(run_));
}

TEST_F(BatchFacets, AFolderIsAssembledByThemAndARunIsRefused) {
  paint(grey_, red_);
  ASSERT_EQ(run({"assemble", scans(), "--out", folder_ / "out", "--facets", painted_}).exit_code, 0);
  SQLite::Database database(folder_ / "out/run/run.sqlite", SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("SELECT name FROM fragment WHERE facets <> ''").getString(), "b7.ply");
  EXPECT_EQ(run({"assemble", without(), "--facets", painted_}).exit_code, 2);
}

TEST_F(BatchFacets, PaintMayLieBesideTheScans) {
  paint(grey_, red_);
  const std::string both = folder_ / "both";
  fs::copy(scans(), both);
  fs::copy(painted_, both);
  const Finished done = run({"batch", both, "--out", run_, "--facets", both + "/."});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  SQLite::Database database(run_ + "/run.sqlite", SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("SELECT name FROM fragment WHERE facets <> ''").getString(), "b7.ply");
}

}  // namespace
}  // namespace rejoin::cli::testing
