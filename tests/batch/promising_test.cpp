#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "../match/planted_block.hpp"
#include "batch/batch.hpp"
#include "mesh/save.hpp"

namespace rejoin::batch {
namespace {

namespace fs = std::filesystem;

class Stages : public Listener {
 public:
  void on_pair(const store::Pair& pair, const Progress& /*progress*/) override {
    of[pair.name_a + "+" + pair.name_b] = pair.stage;
  }

  std::map<std::string, store::Stage> of;
};

TEST(Promising, PairsAloneAreSearchedInFullInFoldersOfManyScans) {
  constexpr int kCells = 5;
  const fs::path home = fs::path(::testing::TempDir()) / "rejoin-promising";
  fs::remove_all(home);
  fs::create_directories(home / "scans");
  const auto joined = match::testing::planted_pair(7, kCells);
  mesh::save((home / "scans/a7.ply").string(), joined.a);
  mesh::save((home / "scans/b7.ply").string(), joined.b);
  mesh::save((home / "scans/a8.ply").string(), match::testing::planted_pair(8, kCells).a);
  Options options;
  options.few_scans = 2;
  Stages stages;
  run(home / "scans", home / "run", options, stages, Context{});
  EXPECT_EQ(stages.of.at("a7.ply+a8.ply"), store::Stage::Sweep);
  EXPECT_EQ(stages.of.at("a7.ply+b7.ply"), store::Stage::Match);
  fs::remove_all(home);
}

}  // namespace
}  // namespace rejoin::batch
