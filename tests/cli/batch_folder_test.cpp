/// Folders whose scans come, go and cannot be read from one run to the next.
#include <gtest/gtest.h>

#include "../match/planted_block.hpp"
#include "batch_runs.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {
namespace fs = std::filesystem;

/// Three pieces of two blocks.
class BatchFolder : public ::testing::Test {
 protected:
  void SetUp() override { make_scans(scans_); }

  Finished batch(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"batch", scans_, "--out", run_};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  const TemporaryFolder folder_;
  const std::string scans_ = folder_ / "scans";
  const std::string run_ = folder_ / "run";
};

TEST_F(BatchFolder, ShardOfAFolderThatChangedCountsItsOwnPairsAlone) {
  const auto third = match::testing::planted_pair(9, kCells);
  mesh::save(scans_ + "/c1.ply", third.a);
  mesh::save(scans_ + "/c2.ply", third.b);
  ASSERT_EQ(batch({"--shard", "1/2"}).exit_code, 0);
  const int before = pairs_in(run_);
  fs::remove(scans_ + "/c2.ply");
  const Finished finished = batch({"--shard", "1/2"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find(", 3 of 3 pairs done, 0 of them now"), std::string::npos) << finished.out;
  EXPECT_GT(pairs_in(run_), 3) << "pairs of " << before << " that the shard had of the larger folder";
}

TEST_F(BatchFolder, ShardKeepsTheScansThatOtherShardsHaveNow) {
  ASSERT_EQ(batch({"--shard", "2/2"}).exit_code, 0);
  const int before = pairs_in(run_);
  mesh::save(scans_ + "/c.ply", match::testing::planted_pair(9, kCells).a);
  const Finished finished = batch({"--shard", "2/2"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  ASSERT_NE(finished.out.find("3 of 3 pairs done, 2 of them now"), std::string::npos)
      << "the shard has other pairs than before: " << finished.out;
  EXPECT_EQ(finished.err.find("is gone"), std::string::npos) << finished.err;
  EXPECT_EQ(pairs_in(run_), before + 2);
}

TEST_F(BatchFolder, CopyOfAScanThatCannotBeReadStaysACopy) {
  fs::copy_file(scans_ + "/b7.ply", scans_ + "/c7.ply");
  ASSERT_EQ(batch().exit_code, 0);
  fs::remove(scans_ + "/b7.ply");
  fs::create_symlink("elsewhere/b7.ply", scans_ + "/b7.ply");
  const Finished finished = batch();
  EXPECT_NE(finished.err.find("b7.ply: cannot be read now; what is known of it stays"), std::string::npos)
      << finished.err;
  EXPECT_NE(finished.out.find("3 of 3 pairs done, 0 of them now"), std::string::npos) << finished.out;
  EXPECT_EQ(pairs_in(run_), 3);
}

}  // namespace
}  // namespace rejoin::cli::testing
