#include "batch/painted.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"

namespace rejoin::batch {
namespace {
namespace fs = std::filesystem;

class FindPainted : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "rejoin-painted-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void make(const std::string& name) const { std::ofstream(folder_ / name) << "x"; }

  void expect_refused(const std::string& says, const std::vector<std::string>& scans) const {
    try {
      find_painted(folder_, scans);
      ADD_FAILURE() << says;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

TEST_F(FindPainted, KnowsScansByTheirNamesAndLeavesOtherFilesAlone) {
  for (const char* name : {"a-facets.ply", "b.c-facets.ply", ".d-facets.ply", "d.ply", "project.mlp"})
    make(name);
  const auto [painted, warnings] = find_painted(folder_, {"a.obj", "b.c.ply", "d.ply"});
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(painted.size(), 2U);
  EXPECT_EQ(painted.at("a.obj"), folder_ / "a-facets.ply");
  EXPECT_EQ(painted.at("b.c.ply"), folder_ / "b.c-facets.ply");
}

TEST_F(FindPainted, TellsWhatItLeavesOutAndWhatItUsesTwice) {
  for (const char* name : {"a-facets.ply", "b-facets.obj", "gone-facets.ply"}) make(name);
  const auto [painted, warnings] = find_painted(folder_, {"a.obj", "a.ply", "b.ply"});
  EXPECT_EQ(painted, (Painted{{"a.obj", folder_ / "a-facets.ply"}, {"a.ply", folder_ / "a-facets.ply"}}));
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_NE(warnings[0].find("a-facets.ply: is used for a.obj and a.ply"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("b-facets.obj: left out, is no PLY"), std::string::npos) << warnings[1];
  EXPECT_NE(warnings[2].find("gone-facets.ply: left out, belongs to no scan"), std::string::npos)
      << warnings[2];
}

TEST_F(FindPainted, RefusesAFolderWithoutAny) {
  expect_refused("holds no painted surface", {"a.ply", "b.ply"});
  make("a-facets.ply");
  expect_refused("holds no painted surface of a scan", {"b.ply", "c.ply"});
  EXPECT_THROW(find_painted(folder_ / "nowhere", {"a.ply"}), IoError);
}

TEST_F(FindPainted, KeepsACopyByItsContent) {
  make("a-facets.ply");
  const std::string hash = keep_painted(folder_ / "a-facets.ply", folder_);
  EXPECT_TRUE(fs::exists(folder_ / (hash + "-facets.ply")));
  std::ofstream(folder_ / (hash + "-facets.ply")) << "cut short";
  EXPECT_EQ(keep_painted(folder_ / "a-facets.ply", folder_), hash);
  EXPECT_EQ(fs::file_size(folder_ / (hash + "-facets.ply")), 1U) << "made again";
}

}  // namespace
}  // namespace rejoin::batch
