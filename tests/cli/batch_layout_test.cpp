/// rejoin batch and assemble with scans that the user laid together by hand.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "../match/planted_block.hpp"
#include "batch_runs.hpp"
#include "core/angle.hpp"
#include "core/random.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

using Poses = std::vector<std::pair<std::string, Rigid>>;

json rows_of(const Rigid& pose) {
  json rows = json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back(
        {pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row], pose.translation[row]});
  rows.push_back({0, 0, 0, 1});
  return rows;
}

/// As MeshLab saves it.
void write_project(const std::string& file, const Poses& poses) {
  std::string text = "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n";
  for (const auto& [name, pose] : poses) {
    text += "  <MLMesh visible=\"1\" idInFile=\"-1\" filename=\"scans/" + name + "\" label=\"" + name +
            "\">\n   <MLMatrix44>\n";
    for (const json& row : rows_of(pose)) {
      for (const json& value : row) text += value.dump() + " ";
      text += "\n";
    }
    text += "</MLMatrix44>\n  </MLMesh>\n";
  }
  write_file(file, text + " </MeshGroup>\n <RasterGroup/>\n</MeshLabProject>\n");
}

class BatchLayout : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home_ = new TemporaryFolder;
    make_scans(scans());
    ASSERT_EQ(run({"batch", scans(), "--out", *home_ / "without"}).exit_code, 0);
  }
  static void TearDownTestSuite() {
    delete home_;
    home_ = nullptr;
  }

  static std::string scans() { return *home_ / "scans"; }
  static std::string without() { return *home_ / "without"; }

  /// Where b7.ply lies if a7.ply stays, turned about its middle against the true place.
  static Rigid laid_b(double turn_deg) {
    const match::testing::PlantedPair pair = match::testing::planted_pair(7, kCells);
    const glm::dvec3 centre = pair.truth(pair.b.origin + mesh::centroid(pair.b));
    const glm::dmat3 turn = axis_rotation(glm::normalize(glm::dvec3(1, 2, -2)), turn_deg * kDegree);
    return Rigid{turn, centre - turn * centre + glm::dvec3(3, -2, 4)} * pair.truth;
  }

  /// The layout's file of a7.ply, which stays, and others.
  std::string layout(Poses poses) const {
    poses.insert(poses.begin(), {"a7.ply", Rigid{}});
    write_project(folder_ / "laid.mlp", poses);
    return folder_ / "laid.mlp";
  }

  Finished batch(const std::string& layout, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"batch", scans(), "--out", run_, "--layout", layout};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  static TemporaryFolder* home_;
  const TemporaryFolder folder_;
  const std::string run_ = folder_ / "run";
  const Rigid far_ = {glm::dmat3(1.0), {5000, 0, 0}};
};
TemporaryFolder* BatchLayout::home_ = nullptr;

TEST_F(BatchLayout, PairsOfItAreLookedForNearTheirPlacesOrNotAtAll) {
  const Finished finished = batch(layout({{"b7.ply", laid_b(15)}, {"a8.ply", far_}}));
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(stages_in(run_), (std::vector<std::string>{"a7.ply+a8.ply: apart", "a7.ply+b7.ply: match",
                                                       "a8.ply+b7.ply: apart"}));
  const std::string table = read_file(run_ + "/pairs.csv");
  EXPECT_NE(table.find("a7.ply,a8.ply,0.000000,no join,apart,0.000,\n"), std::string::npos) << table;
  EXPECT_TRUE(has_the_join(run_));
  EXPECT_EQ(run({"assemble", run_}).out.find("3 of 3 placed"), std::string::npos);
}

TEST_F(BatchLayout, AFalsePlaceHidesTheTrueOne) {
  ASSERT_EQ(batch(layout({{"b7.ply", laid_b(120)}})).exit_code, 0);
  EXPECT_TRUE(has_the_join(without()));
  EXPECT_FALSE(has_the_join(run_));
  EXPECT_EQ(stages_in(run_)[1], "a7.ply+b7.ply: match") << "in full, however weak";
}

TEST_F(BatchLayout, OfAChangedOneOnlyThePairsThatItConcernsAreDoneAgain) {
  fs::copy(without(), run_, fs::copy_options::recursive);
  const Finished first = batch(layout({{"b7.ply", laid_b(15)}}));
  EXPECT_NE(first.out.find("3 of 3 pairs done, 1 of them now"), std::string::npos) << first.out;
  EXPECT_NE(first.err.find("1 pair is laid otherwise than before"), std::string::npos) << first.err;
  EXPECT_NE(batch(layout({{"b7.ply", laid_b(15)}})).out.find(", 0 of them now"), std::string::npos);
  EXPECT_NE(batch(layout({{"b7.ply", laid_b(10)}})).out.find(", 1 of them now"), std::string::npos);
  EXPECT_NE(batch(layout({{"b7.ply", laid_b(10)}, {"a8.ply", far_}})).out.find(", 2 of them now"),
            std::string::npos);
  const Finished dropped = run({"batch", scans(), "--out", run_});
  EXPECT_NE(dropped.out.find("3 of 3 pairs done, 3 of them now"), std::string::npos) << dropped.out;
  EXPECT_EQ(content(run_), content(without()));
}

TEST_F(BatchLayout, KilledAndResumedWithAnyThreadsIsAsUndisturbed) {
  const std::string file = layout({{"b7.ply", laid_b(15)}});
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(batch(file, {"--threads", "1"}).exit_code, 0);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  const std::string place = folder_ / "killed";
  const std::vector<std::string> words{"batch", scans(), "--out", place, "--layout", file, "--threads", "3"};
  Random random(5);
  for (int kill = 0; kill < 6; ++kill) {
    Running program(words);
    std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform(0.0, 0.4 * whole.count())));
    program.kill_now();
    program.finish();
  }
  ASSERT_EQ(run(words).exit_code, 0);
  EXPECT_EQ(content(place), content(run_));
}

TEST_F(BatchLayout, ShardsAreTheWholeAndThoseOfAnotherOneAreRefused) {
  const std::string file = layout({{"b7.ply", laid_b(15)}});
  ASSERT_EQ(batch(file).exit_code, 0);
  std::vector<std::string> merge = {"merge", "--out", folder_ / "whole"};
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    merge.push_back(folder_ / std::string(1, shard[0]));
    ASSERT_EQ(run({"batch", scans(), "--out", merge.back(), "--shard", shard, "--layout", file}).exit_code,
              0);
  }
  ASSERT_EQ(run(merge).exit_code, 0);
  EXPECT_EQ(content(folder_ / "whole"), content(run_));
  const std::string other = layout({{"b7.ply", laid_b(10)}});
  ASSERT_EQ(run({"batch", scans(), "--out", folder_ / "3", "--shard", "3/3", "--layout", other}).exit_code,
            0);
  const Finished refused = run(merge);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("elsewhere in the layout"), std::string::npos) << refused.err;
}

TEST_F(BatchLayout, PlaceOfACopyIsThatOfTheScanThatStandsForIt) {
  make_scans(folder_ / "scans");
  fs::rename(folder_ / "scans/b7.ply", folder_ / "scans/b.ply");
  fs::copy_file(folder_ / "scans/b.ply", folder_ / "scans/b-copy.ply");
  const std::vector<std::string> words{"batch", folder_ / "scans", "--out",
                                       run_,    "--layout",        layout({{"b-copy.ply", far_}})};
  ASSERT_EQ(run(words).exit_code, 0);
  EXPECT_EQ(stages_in(run_)[1], "a7.ply+b.ply: apart");
}

TEST_F(BatchLayout, AFolderIsAssembledByItAndARunIsNot) {
  const std::string file = layout({{"b7.ply", far_}});
  const Finished apart = run({"assemble", scans(), "--out", folder_ / "out", "--layout", file});
  ASSERT_EQ(apart.exit_code, 0) << apart.err;
  EXPECT_EQ(stages_in(folder_ / "out/run")[1], "a7.ply+b7.ply: apart");
  const Finished refused = run({"assemble", without(), "--layout", file});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--layout: serves a folder of scans"), std::string::npos) << refused.err;
}

TEST_F(BatchLayout, OneThatCannotBeUsedIsToldBeforeAnythingIsWritten) {
  write_file(folder_ / "laid.json", R"({"poses": {"a7.ply": [[1]]}})");
  const Finished refused = batch(folder_ / "laid.json");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("laid.json: \"poses\".\"a7.ply\" is no 4 x 4 matrix"), std::string::npos)
      << refused.err;
  EXPECT_FALSE(fs::exists(run_));
}

#ifdef REJOIN_VIEWER
TEST_F(BatchLayout, ThePageTellsIt) {
  ASSERT_EQ(batch(layout({{"b7.ply", far_}})).exit_code, 0);
  ASSERT_EQ(run({"report", run_, "--pictures", "0"}).exit_code, 0);
  const std::string page = read_file(run_ + "/report.html");
  EXPECT_NE(page.find("lays 2 of 3 scans"), std::string::npos);
  EXPECT_NE(page.find("\"compared\":2,\"failed\":0,\"apart\":1,"), std::string::npos);
}
#endif

}  // namespace
}  // namespace rejoin::cli::testing
