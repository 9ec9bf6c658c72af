#include "batch/inputs.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

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

  std::string error_of_find() const {
    try {
      find_scans(folder_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(Inputs, ScansAreFoundByExtensionInAnyCaseAndSorted) {
  for (const char* name : {"b.PLY", "a.drc", "truth.json", "readme.txt", "c.glb", "d.ply.part", "._b.PLY",
                           "assembled.ply", "joined.glb"})
    put(name, "x");
  fs::create_directory(folder_ / "folder.ply");
  ASSERT_EQ(mkfifo((folder_ / "pipe.ply").c_str(), 0600), 0);
  EXPECT_EQ(names_of(find_scans(folder_)), (std::vector<std::string>{"a.drc", "b.PLY", "c.glb"}));
  EXPECT_EQ(find_scans(folder_).at("b.PLY"), folder_ / "b.PLY");
  EXPECT_EQ(told_of_models(folder_).find("assembled.ply, joined.glb: left out"), 0U)
      << told_of_models(folder_);
}

TEST_F(Inputs, PaintedSurfacesBesideTheirScansAreNoScans) {
  for (const char* name : {"a.ply", "a-facets.ply", "b.obj", "b-facets.ply", "cut-facets.ply"})
    put(name, "x");
  EXPECT_EQ(names_of(find_scans(folder_)), (std::vector<std::string>{"a.ply", "b.obj", "cut-facets.ply"}))
      << "nothing is painted on a scan that is not there";
  EXPECT_EQ(told_of_painted(folder_).find("2 files in "), 0U) << told_of_painted(folder_);
  EXPECT_NE(told_of_painted(folder_).find("(a-facets.ply, ...) taken for no scan"), std::string::npos)
      << told_of_painted(folder_);
  for (const char* name : {"a-facets.ply", "b-facets.ply"}) fs::remove(folder_ / name);
  EXPECT_EQ(told_of_painted(folder_), "");
}

TEST_F(Inputs, PaintedSurfacesInFoldersOfOneScanEachAreTold) {
  for (const char* name : {"1/a.ply", "1/a-facets.ply", "2/b.ply"}) {
    fs::create_directories((folder_ / name).parent_path());
    put(name, "x");
  }
  EXPECT_EQ(names_of(find_scans(folder_)).size(), 2U);
  EXPECT_NE(told_of_painted(folder_).find("(1/a-facets.ply)"), std::string::npos) << told_of_painted(folder_);
}

TEST_F(Inputs, FoldersBelowWithScansAreTold) {
  put("a.ply", "x");
  for (const char* name : {"notes", "result", "fragments", ".Trash", "old", "old/run", "old/run/fragments"})
    fs::create_directory(folder_ / name);
  put("run.sqlite", "");
  put("notes/find.txt", "x");
  put("result/joined.ply", "x");
  put("fragments/kept.drc", "x");
  put("old/run/run.sqlite", "");
  put("old/run/fragments/kept.drc", "x");
  put(".Trash/old.ply", "x");
  EXPECT_EQ(told_of_folders(folder_), "") << "no scans, a model, what a run keeps, and what is hidden";
  fs::create_directory(folder_ / "trench 2");
  put("trench 2/a.ply", "x");
  EXPECT_EQ(told_of_folders(folder_).find("1 folder with scans below "), 0U) << told_of_folders(folder_);
  EXPECT_NE(told_of_folders(folder_).find("(trench 2) left out"), std::string::npos);
  fs::create_directories(folder_ / "phone/07");
  put("phone/07/textured.obj", "x");
  fs::create_directory_symlink(folder_ / "phone/07", folder_ / "linked");
  fs::create_directory_symlink(folder_, folder_ / "phone/round");
  EXPECT_EQ(told_of_folders(folder_).find("4 folders with scans below "), 0U) << told_of_folders(folder_);
  EXPECT_NE(told_of_folders(folder_).find("(linked, ...) left out"), std::string::npos);
  EXPECT_NE(error_of_find().find("holds one scan only; put all scans into one folder, or each into"),
            std::string::npos)
      << error_of_find();
}

TEST_F(Inputs, ScansInFoldersOfTheirOwnGoByTheFoldersNames) {
  for (const char* name : {"07", "08.b/source", "notes", ".Trash"}) fs::create_directories(folder_ / name);
  put("07/textured.obj", "x");
  put("07/textured.jpg", "x");
  put("08.b/source/textured.obj", "x");
  put(".Trash/old.ply", "x");
  const Scans expected{{"07", folder_ / "07/textured.obj"}, {"08.b", folder_ / "08.b/source/textured.obj"}};
  EXPECT_EQ(find_scans(folder_), expected);
  EXPECT_EQ(told_of_folders(folder_), "");
  put("08.b/raw.ply", "x");
  EXPECT_NE(error_of_find().find("08.b: holds several scans; give it alone, or leave one"), std::string::npos)
      << error_of_find();
  fs::remove(folder_ / "08.b/raw.ply");
  put("c.ply", "x");
  EXPECT_NE(error_of_find().find("holds one scan only"), std::string::npos) << error_of_find();
}

TEST_F(Inputs, ScansOfOtherFormatsAreTold) {
  fs::create_directories(folder_ / "07");
  for (const char* name : {"a.ply", "b.ply", "notes.txt", "07/textured.mtl"}) put(name, "x");
  EXPECT_EQ(told_of_formats(folder_), "");
  put("c.E57", "x");
  put("07/textured.fbx", "x");
  EXPECT_EQ(told_of_formats(folder_),
            "2 files of other formats in " + folder_.string() +
                " (07/textured.fbx, ...) left out: export as PLY what is to be matched, too");
}

TEST_F(Inputs, TooFewScansAreAnError) {
  EXPECT_THROW(find_scans(folder_), InputError);
  put("a.ply", "x");
  EXPECT_THROW(find_scans(folder_), InputError);
  EXPECT_THROW(find_scans(folder_ / "nowhere"), IoError);
}

TEST_F(Inputs, RunInPlaceOfItsScansIsToldAsOne) {
  put("run.sqlite", "x");
  EXPECT_NE(error_of_find().find("it is a run"), std::string::npos) << error_of_find();
}

TEST_F(Inputs, NameThatIsNoUtf8IsRefusedAsItCouldNotBeToldApart) {
  for (const char* name : {"a.ply", "Gef\xe4\xdf.ply", "Gef\xe4\xe4.ply"}) put(name, "x");
  EXPECT_NE(error_of_find().find("Gef\uFFFD\uFFFD.ply: has a name"), std::string::npos) << error_of_find();
}

TEST_F(Inputs, NamesThatNoResultCanTellAreLeftOutAmongOthers) {
  for (const char* name : {"a.ply", "b.ply", "c\td.ply", "Gef\xe4\xdf.ply"}) put(name, "x");
  EXPECT_EQ(names_of(find_scans(folder_)), (std::vector<std::string>{"a.ply", "b.ply"}));
  const std::vector<store::Fragment> left_out = untellable_scans(folder_);
  ASSERT_EQ(left_out.size(), 2U);
  EXPECT_NE(left_out[0].error.find("no UTF-8"), std::string::npos) << left_out[0].error;
  EXPECT_NE(left_out[1].error.find("control character"), std::string::npos) << left_out[1].error;
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
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(content_hash(folder_ / "pipe"), IoError) << "a pipe would be waited for";
}

TEST_F(Inputs, HashOfAGltfIsOfItsBuffersToo) {
  const std::string json = R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "data:,x", "byteLength": 1},)"
                           R"( {"uri": "a%20buffer.bin", "byteLength": 3}]})";
  put("a.gltf", json);
  EXPECT_EQ(hash_if_readable(folder_ / "a.gltf"), store::kUnreadable);
  put("a buffer.bin", "one");
  const std::string before = content_hash(folder_ / "a.gltf");
  put("a buffer.bin", "two");
  EXPECT_NE(content_hash(folder_ / "a.gltf"), before);
  put("a buffer.bin", "one");
  EXPECT_EQ(content_hash(folder_ / "a.gltf"), before);
  put("no.gltf", "{");
  EXPECT_NE(hash_if_readable(folder_ / "no.gltf"), store::kUnreadable);
}

TEST_F(Inputs, ChangedScansAreToldByName) {
  put("a.ply", "one");
  put("b.ply", "two");
  std::vector<store::Fragment> fragments(4);
  for (std::size_t k = 0; k < fragments.size(); ++k) {
    fragments[k].name = std::string(1, static_cast<char>('a' + k)) + ".ply";
    fragments[k].path = folder_ / fragments[k].name;
    fragments[k].hash = hash_if_readable(folder_ / "a.ply");
    fragments[k].state = k == 3 ? store::FragmentState::Bad : store::FragmentState::Ready;
  }
  const ChangedScans scans = changed_scans(fragments);
  EXPECT_EQ(scans.changed, std::vector<std::string>{"b.ply"});
  EXPECT_EQ(scans.gone, std::vector<std::string>{"c.ply"});
  EXPECT_EQ(told(scans, "shown is"),
            (std::vector<std::string>{
                "1 scan cannot be read where rejoin batch found it (c.ply); shown is what the run keeps",
                "1 scan changed since rejoin batch matched it (b.ply); shown is what the run keeps: run "
                "rejoin batch again"}));
  EXPECT_TRUE(told({}, "shown is").empty());
}

TEST_F(Inputs, CopiesAreFoundByContentAndTheShortestNameStandsForAll) {
  put("Copy of c.ply", "one");
  put("b.ply", "two");  // as long as the others
  put("c.ply", "one");
  put("d.ply", "one more");
  put("e.ply", "one");
  const std::map<std::string, std::string> expected{{"Copy of c.ply", "c.ply"}, {"e.ply", "c.ply"}};
  Scans scans = find_scans(folder_);
  scans["gone.ply"] = folder_ / "gone.ply";
  const std::vector<store::Fragment> files = files_of_equal_size(scans);
  EXPECT_EQ(files.size(), 4U) << "d.ply has a size of its own and need not be read";
  EXPECT_EQ(store::copies(files), expected);
}

}  // namespace
}  // namespace rejoin::batch
