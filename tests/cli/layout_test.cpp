/// The file of --layout, good and hostile.
#include "cli/layout.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

const batch::Scans kScans{{"a.ply", "gone/a.ply"}, {"b & c.ply", "gone/b & c.ply"}, {"d.ply", "gone/d.ply"}};

constexpr const char* kTurned = "0 -1 0 5 \n1 0 0 6 \n0 0 1 7 \n0 0 0 1 \n";

batch::Layout read(const std::string& content) {
  const TemporaryFolder folder;
  write_file(folder / "laid", content);
  return read_layout(folder / "laid", kScans).layout;
}

std::string layer(const std::string& file, const std::string& matrix, const std::string& more = "") {
  return "<MLMesh " + more + " label=\"x\" filename=\"" + file + "\"><MLMatrix44>\n" + matrix +
         "</MLMatrix44><RenderingOption pointSize=\"3\"/></MLMesh>\n";
}

std::string project(const std::string& layers) {
  return "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n" + layers +
         " </MeshGroup>\n <RasterGroup/>\n</MeshLabProject>\n";
}

TEST(ReadLayout, TakesTheLayersOfAMeshLabProjectByTheNamesOfTheirFiles) {
  const batch::Layout layout =
      read("\xEF\xBB\xBF" + project(layer("../scans/b &amp; c.ply", kTurned, "visible=\"1\"") +
                                    layer("C:\\scans\\d.ply", kTurned) + "<MLMesh filename=\"a.ply\"/>"));
  ASSERT_EQ(layout.size(), 3U);
  EXPECT_EQ(layout.at("b & c.ply")({1, 0, 0}), glm::dvec3(5, 7, 7));
  EXPECT_EQ(layout.at("d.ply")({1, 0, 0}), glm::dvec3(5, 7, 7));
  EXPECT_EQ(layout.at("a.ply")({1, 2, 3}), glm::dvec3(1, 2, 3)) << "was not moved";
}

TEST(ReadLayout, TakesLayersOfScansThatGoByTheirFoldersNames) {
  const TemporaryFolder folder;
  write_file(folder / "laid",
             project(layer("box/07/textured.obj", kTurned) + layer("08\\source\\textured.obj", kTurned)));
  const batch::Layout layout = read_layout(folder / "laid", {{"07", "gone/07"}, {"08", "gone/08"}}).layout;
  EXPECT_EQ(layout.count("07"), 1U);
  EXPECT_EQ(layout.count("08"), 1U);
}

TEST(ReadLayout, LeavesOutWhatIsHiddenInMeshLab) {
  const batch::Layout layout = read(project(layer("a.ply", kTurned) + layer("d.ply", kTurned) +
                                            layer("b &amp; c.ply", kTurned, "visible=\"0\"") +
                                            layer("table.ply", kTurned, "visible=\"0\"")));
  EXPECT_EQ(layout.size(), 2U);
  EXPECT_EQ(layout.count("b & c.ply"), 0U);
}

TEST(ReadLayout, TakesThePosesOfConstraintsAndOfAnAssembly) {
  const std::string rows = "[[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]";
  const batch::Layout poses = read(R"({"poses": {"a.ply": )" + rows + R"(, "d.ply": )" + rows + "}}");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses.at("d.ply")({1, 0, 0}), glm::dvec3(5, 7, 7));
  const batch::Layout assembly = read(R"({"schema": "rejoin.assembly/1", "fragments": {"a.ply": {"pose": )" +
                                      rows + R"(, "group": 0}, "b & c.ply": {"pose": )" + rows +
                                      R"(, "group": 1}, "d.ply": {"pose": )" + rows + R"(, "group": 0}}})");
  ASSERT_EQ(assembly.size(), 2U) << "how objects lie to each other nobody knows";
  EXPECT_EQ(assembly.at("d.ply")({1, 0, 0}), glm::dvec3(5, 7, 7));
}

TEST(ReadLayout, LeavesOutScansThatTheAssemblyDidNotHave) {
  const TemporaryFolder folder;
  batch::Scans scans;
  std::string fragments;
  for (const char* name : {"a.ply", "b & c.ply", "d.ply"}) {
    scans[name] = folder / name;
    write_file(folder / name, name);
    fragments += std::string(fragments.empty() ? "" : ", ") + "\"" + name +
                 "\": {\"pose\": [[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]], \"group\": 0, "
                 "\"scan\": \"" +
                 batch::content_hash(folder / name) + "\"}";
  }
  write_file(folder / "assembly.json",
             R"({"schema": "rejoin.assembly/1", "fragments": {)" + fragments + "}}");
  EXPECT_EQ(read_layout(folder / "assembly.json", scans).layout.size(), 3U);
  write_file(folder / "d.ply", "exported again, with another origin");
  std::filesystem::remove(folder / "b & c.ply");
  const LaidScans laid = read_layout(folder / "assembly.json", scans);
  EXPECT_EQ(laid.layout.size(), 2U) << "what cannot be read now may be the same";
  EXPECT_EQ(laid.layout.count("d.ply"), 0U);
  ASSERT_EQ(laid.warnings.size(), 1U);
  EXPECT_NE(laid.warnings[0].find("the place of d.ply is left out"), std::string::npos) << laid.warnings[0];
  write_file(folder / "a.ply", "so is this one");
  try {
    read_layout(folder / "assembly.json", scans);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("lays only b & c.ply of the folder's scans as they are now"),
              std::string::npos)
        << error.what();
  }
}

TEST(ReadLayout, RefusesWhatIsNoneWithTheReason) {
  const std::string a = layer("a.ply", kTurned);
  const std::string rows = "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "neither a MeshLab project nor JSON"},
      {"a.ply 1 0 0", "neither a MeshLab project nor JSON"},
      {"<MeshLabProject><MeshGroup>", "is no MeshLab project: "},
      {"<svg/>", "is no MeshLab project"},
      {project(""), "lays none of the folder's scans"},
      {project(a), "lays only a.ply of the folder's scans"},
      {"{}", "lays none of the folder's scans"},
      {project(a + a), "lays \"a.ply\" twice"},
      {project(a + layer("table.ply", kTurned)), "lays \"table.ply\", which is no scan of the folder"},
      {project(a + layer("d.ply", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n")),
       "the matrix of \"d.ply\" is no rotation: products of its columns are 3 off, and 0.002 is what "
       "rounding "
       "may leave; in MeshLab"},
      {project(a + layer("d.ply", "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")),
       "the matrix of \"d.ply\" is no rotation, as it mirrors; in MeshLab"},
      {project(a + layer("d.ply", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")), "the matrix of \"d.ply\""},
      {project(a + layer("d.ply", "1 0 0 0\n")),
       "the matrix of \"d.ply\" is no 4 x 4 matrix of numbers whose last row is 0, 0, 0, 1; save the "
       "project"},
      {project(a + layer("d.ply", "1 0 0 1e14\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")),
       "the matrix of \"d.ply\" shifts by more than 1e13; save the project"},
      {project(a + layer("d.ply", "1 0 0 0,5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")),
       "the matrix of \"d.ply\" has decimal commas; write its numbers with points"},
      {R"({"poses": {"a.ply": )" + rows + R"(, "e.ply": )" + rows + "}}", "no fragment \"e.ply\""},
      {R"({"must_join": [["a.ply", "d.ply"]], "poses": {"a.ply": )" + rows + R"(, "d.ply": )" + rows + "}}",
       "says which pairs must or must not join"},
      {R"({"schema": "rejoin.match/1", "fragments": {}})", "is no assembly"},
      {R"({"schema": "rejoin.assembly/1", "fragments": []})", "is no assembly"},
      {R"({"schema": "rejoin.assembly/1", "fragments": {"a.ply": {"pose": 1}}})", "the matrix of \"a.ply\""},
      {R"({"schema": "rejoin.assembly/1", "fragments": {"e.ply": {"pose": )" + rows + "}}}",
       "lays \"e.ply\", which is no scan"}};
  for (const auto& [content, says] : cases) {
    try {
      read(content);
      ADD_FAILURE() << content;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("; "), std::string::npos) << "no mend: " << error.what();
    }
  }
  EXPECT_THROW(read_layout("/nowhere/laid.mlp", kScans), IoError);
}

}  // namespace
}  // namespace rejoin::cli::testing
