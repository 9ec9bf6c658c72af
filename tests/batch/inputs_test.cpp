#include "batch/inputs.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/error.hpp"

namespace rejoin::batch {
namespace {
namespace fs = std::filesystem;

class Inputs : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "rejoin-inputs-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }

  fs::path folder_;
};

TEST_F(Inputs, ScansAreFoundByExtensionInAnyCaseAndSorted) {
  for (const char* name : {"b.PLY", "a.drc", "truth.json", "readme.txt", "c.glb", "d.ply.part", "._b.PLY"})
    put(name, "x");
  fs::create_directory(folder_ / "folder.ply");
  EXPECT_EQ(find_scans(folder_), (std::vector<std::string>{"a.drc", "b.PLY", "c.glb"}));
}

TEST_F(Inputs, TooFewScansAreAnError) {
  EXPECT_THROW(find_scans(folder_), InputError);
  put("a.ply", "x");
  EXPECT_THROW(find_scans(folder_), InputError);
  EXPECT_THROW(find_scans(folder_ / "nowhere"), IoError);
}

TEST_F(Inputs, HashTellsContentNotName) {
  const std::string large(3U << 20U, 'x');
  put("a", large);
  put("b", large);
  put("c", large + "y");
  put("empty", "");
  EXPECT_EQ(content_hash(folder_ / "a"), content_hash(folder_ / "b"));
  EXPECT_NE(content_hash(folder_ / "a"), content_hash(folder_ / "c"));
  EXPECT_EQ(content_hash(folder_ / "empty"), "99aa06d3014798d86001c324468d497f") << "XXH3-128 of nothing";
  EXPECT_THROW(content_hash(folder_ / "nowhere"), IoError);
}

TEST_F(Inputs, CopiesAreFoundByContentAndTheShortestNameStandsForAll) {
  put("Copy of c.ply", "one");
  put("b.ply", "two");  // as long as the others
  put("c.ply", "one");
  put("d.ply", "one more");
  put("e.ply", "one");
  const std::map<std::string, std::string> expected{{"Copy of c.ply", "c.ply"}, {"e.ply", "c.ply"}};
  const std::vector<store::Fragment> files =
      files_of_equal_size(folder_, {"Copy of c.ply", "b.ply", "c.ply", "d.ply", "e.ply", "gone.ply"});
  EXPECT_EQ(files.size(), 4U) << "d.ply has a size of its own and need not be read";
  EXPECT_EQ(store::copies(files), expected);
}

}  // namespace
}  // namespace rejoin::batch
