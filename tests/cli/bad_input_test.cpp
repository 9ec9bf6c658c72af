/// Faulty files and places: one line that names them, exit code 1.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

const std::string kTetrahedron =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// A binary PLY of `promised` vertices with the data of `given` only.
std::string binary_ply(const std::string& promised, int given) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + promised +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " + promised +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < given; ++i) {
    const float point[3] = {static_cast<float>(i), static_cast<float>(i * i), 1.0F};
    text.append(reinterpret_cast<const char*>(point), sizeof point);
  }
  return text;
}

struct BadFile {
  const char* name;
  const char* file;
  std::string content;
};

/// What GoogleTest and CTest show for the case.
void PrintTo(const BadFile& value, std::ostream* out) {
  *out << value.name;
}

class BadFileTest : public ::testing::TestWithParam<BadFile> {};

void expect_failure(const Finished& finished, const std::string& names) {
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(finished.out, "");
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find(names), std::string::npos) << finished.err;
}

TEST(HostileName, NeitherSteersTheTerminalNorMakesLines) {
  const TemporaryFolder folder;
  const std::string name = folder / "a\033[2J\nrejoin: done\r.ply";
  expect_failure(run({"match", name, folder / "missing.ply"}), "a?[2J?rejoin: done?.ply");
  write_file(name, kTetrahedron);
  expect_failure(run({"facets", name}), "a?[2J?rejoin: done?.ply: has a line end");
  const std::string good = folder / "a.ply";
  write_file(good, kTetrahedron);
  const Finished finished = run({"facets", good, "--json", name + ".json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find("a?[2J"), std::string::npos) << finished.out;
  for (const char c : {'\033', '\r'}) EXPECT_EQ(finished.out.find(c), std::string::npos) << finished.out;
}

TEST(HostileName, ThatBreaksALineIsRefusedInAFolderOfScans) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "b\nc.ply"}) write_file(folder / name, kTetrahedron);
  expect_failure(run({"batch", folder / "", "--out", folder / "run"}), "b?c.ply: has a line end");
}

TEST(HostileName, ThatIsNoUtf8IsRefused) {
  const TemporaryFolder folder;
  const std::string name = folder / "Gef\xe4\xdf.ply";
  write_file(name, kTetrahedron);
  expect_failure(run({"facets", name}), "Gef\uFFFD\uFFFD.ply: has a name");
  expect_failure(run({"match", name, folder / "other.ply"}), "Gef\uFFFD\uFFFD.ply: has a name");
}

TEST(CopiedFile, IsRefusedAsTheOtherFragment) {
  const TemporaryFolder folder;
  write_file(folder / "a.ply", kTetrahedron);
  write_file(folder / "b.ply", kTetrahedron);
  const Finished finished = run({"match", folder / "a.ply", folder / "b.ply"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find("b.ply: is a copy of "), std::string::npos) << finished.err;
}

TEST_P(BadFileTest, IsNamedInOneLineAndExitsWithOne) {
  const TemporaryFolder folder;
  const std::string path = folder / GetParam().file;
  write_file(path, GetParam().content);
  expect_failure(run({"facets", path}), path + ": ");
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadFileTest,
    ::testing::Values(BadFile{"Empty", "empty.ply", ""}, BadFile{"EmptyStl", "empty.stl", ""},
                      BadFile{"EmptyObj", "empty.obj", ""}, BadFile{"EmptyDraco", "empty.drc", ""},
                      BadFile{"EmptyGlb", "empty.glb", ""}, BadFile{"Text", "text.ply", "Dear diary,\n"},
                      BadFile{"TextAsGlb", "text.glb", "Dear diary,\n"},
                      BadFile{"TextAsOff", "text.off", "Dear diary,\n"},
                      BadFile{"TextAsStl", "text.stl", "Dear diary,\n"},
                      BadFile{"Truncated", "cut.ply", binary_ply("100", 50)},
                      BadFile{"BillionFaces", "huge.ply", binary_ply("1000000000", 10)},
                      BadFile{"Nan", "nan.ply", replaced(kTetrahedron, "0 1 0", "0 nan 0")},
                      BadFile{"Infinite", "inf.ply", replaced(kTetrahedron, "0 1 0", "0 inf 0")},
                      BadFile{"IndexOutOfRange", "index.ply", replaced(kTetrahedron, "3 1 2 3", "3 1 2 9")},
                      BadFile{"ZeroArea", "flat.obj",
                              "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\nf 2 3 4\n"},
                      BadFile{"SingleTriangle", "one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
                      BadFile{"TwoPoints", "two.ply",
                              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                              "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                              "end_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n"},
                      BadFile{"UnknownExtension", "scan.xyzzy", kTetrahedron},
                      BadFile{"NoExtension", "scan", kTetrahedron}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(RepairedFileTest, AWarningNamesTheFileOnce) {
  const TemporaryFolder folder;
  const std::string path = folder / "inside_out.ply";
  std::string text = kTetrahedron;
  text.resize(text.find("3 0 2 1"));
  write_file(path, text + "3 0 1 2\n3 0 3 1\n3 1 3 2\n3 0 2 3\n");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"facets", path},
        {"shatter", path, "--out", folder / "pieces", "--spacing", "5"}}) {
    const Finished finished = run(arguments);
    EXPECT_NE(finished.err.find("warning: " + path + ": was inside out, turned all faces\n"),
              std::string::npos)
        << finished.err;
  }
}

TEST(ShatterTest, TellsThatAWallIsTooThinForItsGrid) {
  const TemporaryFolder folder;
  const std::string path = folder / "plate.off";
  write_file(path,
             "OFF\n8 6 0\n0 0 0\n500 0 0\n500 400 0\n0 400 0\n0 0 4\n500 0 4\n500 400 4\n0 400 4\n"
             "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const Finished finished =
      run({"shatter", path, "--out", folder / "pieces", "--pieces", "3", "--spacing", "0.9"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_NE(
      finished.err.find("warning: " + path + ": no two fragments touch: edges of 0.9 % of its diameter"),
      std::string::npos)
      << finished.err;
}

TEST(BadPlace, MissingFileIsNamed) {
  expect_failure(run({"facets", "no/such/scan.ply"}), "no/such/scan.ply");
}

TEST(BadPlace, FolderAsScanIsNamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "scan.ply");
  const std::string scan = folder / "scan.ply";
  expect_failure(run({"facets", scan}),
                 scan + ": is a folder; name a scan in it; rejoin batch takes the folder");
  expect_failure(run({"split", scan, "--out", folder / "out"}), "name the scans in it: " + scan + "/*.ply");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(BadPlace, NanNamesItsVertex) {
  const TemporaryFolder folder;
  write_file(folder / "nan.ply", replaced(kTetrahedron, "0 1 0", "0 nan 0"));
  EXPECT_NE(run({"facets", folder / "nan.ply"}).err.find("vertex 2"), std::string::npos);
}

// A file where a folder is needed stops even root, whom no permission does.
TEST(BadPlace, OutputsAreTestedBeforeTheScansAreRead) {
  const TemporaryFolder folder;
  write_file(folder / "file", "x");
  const std::string inside = folder / "file/inside";
  const std::string missing = folder / "missing/match.json";
  expect_failure(run({"match", "a.ply", "b.ply", "--out", inside}), inside);
  expect_failure(run({"match", "a.ply", "b.ply", "--json", inside}), inside);
  expect_failure(run({"match", "a.ply", "b.ply", "--json", missing}), missing);
  expect_failure(run({"facets", "a.ply", "--json", folder / ""}), folder / "");
  expect_failure(run({"info", "--json", inside}), inside);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which need terabytes of addresses
TEST(BadPlace, TooLittleMemoryIsToldAsThat) {
  const TemporaryFolder folder;
  write_file(folder / "a.ply", kTetrahedron);
  const std::string command =
      "bash -c 'ulimit -v 300000; exec \"$0\" facets \"$1\" --threads 1' " REJOIN_PROGRAM " " +
      (folder / "a.ply") + " 2> " + (folder / "err");
  EXPECT_NE(std::system(command.c_str()), 0);
  const std::string err = read_file(folder / "err");
  EXPECT_TRUE(is_one_line(err)) << err;
  EXPECT_NE(err.find("memory"), std::string::npos) << err;
}
#endif

TEST(BadPlace, BackendThatIsMissingCannotBeMeasured) {
  expect_failure(run({"bench", "--backend", "osmesa"}, {"REJOIN_OSMESA_LIBRARY=no/such/library.so"}),
                 "no/such/library.so");
}

TEST(BadPlace, TheSameFileUnderAnotherNameIsWrongUse) {
  const TemporaryFolder folder;
  write_file(folder / "a.ply", kTetrahedron);
  std::filesystem::create_symlink(folder / "a.ply", folder / "b.ply");
  const Finished finished = run({"match", folder / "a.ply", folder / "b.ply"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
}

}  // namespace
}  // namespace rejoin::cli::testing
