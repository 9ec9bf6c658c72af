#include "batch/shelf.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "../mesh/shapes.hpp"
#include "core/error.hpp"
#include "mesh/save.hpp"

namespace rejoin::batch {
namespace {
namespace fs = std::filesystem;

class Shelved : public ::testing::Test {
 protected:
  void SetUp() override {
    mesh::save(scan_, mesh::test::icosphere(50, 3));
    fragment_.name = "scan.ply";
    fragment_.path = scan_.string();
    fragment_.hash = content_hash(scan_);
  }

  std::size_t faces() const {
    return load_prepared(fragment_, cache_, mesh::PieceKind::Found, Context{}).surface.faces.size();
  }

  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(cache_)) files.push_back(entry.path());
    return files;
  }

  /// As another build would have laid a surface through the scan.
  void keep_of_another_build() const {
    ASSERT_EQ(kept().size(), 1U);
    fs::remove(kept().front());
    mesh::save(cache_ / (fragment_.hash + "-another.drc"), mesh::test::icosphere(50, 2));
  }

  mesh::test::TemporaryFolder folder_;
  fs::path scan_ = folder_ / "scan.ply";
  fs::path cache_ = folder_ / "fragments";
  store::Fragment fragment_;
};

TEST_F(Shelved, SurfaceOfAnotherBuildGivesWayToTheScan) {
  const std::size_t own = faces();
  keep_of_another_build();
  EXPECT_EQ(faces(), own);
  ASSERT_EQ(kept().size(), 1U);
  EXPECT_EQ(kept().front().string().find("another"), std::string::npos);
}

TEST_F(Shelved, SurfaceOfAnotherBuildStandsForAScanThatIsGone) {
  const std::size_t own = faces();
  keep_of_another_build();
  fs::remove(scan_);
  EXPECT_EQ(faces(), mesh::test::icosphere(50, 2).faces.size());
  EXPECT_NE(faces(), own);
  EXPECT_TRUE(kept_surface(fragment_, cache_));
}

TEST_F(Shelved, ScanWithAnotherContentIsRefusedWhereNothingIsKept) {
  mesh::save(scan_, mesh::test::icosphere(40, 3));
  EXPECT_THROW(faces(), InputError);
}

TEST_F(Shelved, ScanThatCannotBeReadNowIsKnownByNoContentSoThatItIsTriedAgain) {
  fs::remove(scan_);
  store::Fragment bad;
  Shelf(cache_, mesh::PieceKind::Found).hold({fragment_}, Context{}, [&](const auto& told, const auto&) {
    bad = told;
  });
  EXPECT_EQ(bad.state, store::FragmentState::Bad);
  EXPECT_EQ(bad.hash, store::kUnreadable);
}

}  // namespace
}  // namespace rejoin::batch
