#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "../match/planted_block.hpp"
#include "batch/batch.hpp"
#include "mesh/save.hpp"

namespace rejoin::batch {
namespace {

namespace fs = std::filesystem;

constexpr int kCells = 5;

class Stages : public Listener {
 public:
  void on_pair(const store::Pair& pair, const Progress& /*progress*/) override {
    of[pair.name_a + "+" + pair.name_b] = pair.stage;
  }

  std::map<std::string, store::Stage> of;
};

/// A folder with three pieces of two blocks, of which a7.ply and b7.ply join.
class Promising : public ::testing::Test {
 protected:
  Promising() {
    std::string pattern = (fs::temp_directory_path() / "rejoin-promising-XXXXXX").string();
    home_ = mkdtemp(pattern.data());
    fs::create_directories(home_ / "scans");
    const auto joined = match::testing::planted_pair(7, kCells);
    add("a7.ply", joined.a);
    add("b7.ply", joined.b);
    add("a8.ply", match::testing::planted_pair(8, kCells).a);
  }
  ~Promising() override { fs::remove_all(home_); }

  void add(const char* name, const mesh::Mesh& scan) const { mesh::save(home_ / "scans" / name, scan); }

  /// The pairs that a run does now, with their stages.
  std::map<std::string, store::Stage> run_of(std::size_t few_scans) const {
    Options options;
    options.few_scans = few_scans;
    Stages stages;
    run(home_ / "scans", home_ / "run", options, stages, Context{});
    return stages.of;
  }

  fs::path home_;
};

TEST_F(Promising, PairsThatEndedAmongManyScansAreSearchedInFullAmongFew) {
  add("b8.ply", match::testing::planted_pair(8, kCells).b);
  const auto among_many = run_of(3);
  EXPECT_EQ(among_many.at("a7.ply+b7.ply"), store::Stage::Match) << "as it is promising";
  ASSERT_EQ(among_many.at("a7.ply+a8.ply"), store::Stage::Sweep);
  fs::remove(home_ / "scans/b8.ply");
  const auto now = run_of(3);
  EXPECT_EQ(now.at("a7.ply+a8.ply"), store::Stage::Match);
  EXPECT_EQ(now.count("a7.ply+b7.ply"), 0U) << "it was searched in full";
  EXPECT_TRUE(run_of(3).empty());
}

TEST_F(Promising, PairsSearchedInFullAmongFewScansStaySoAmongMany) {
  ASSERT_EQ(run_of(3).size(), 3U);
  add("b8.ply", match::testing::planted_pair(8, kCells).b);
  EXPECT_EQ(run_of(3).size(), 3U) << "those of the new scan alone";
}

}  // namespace
}  // namespace rejoin::batch
