/// rejoin split
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "../mesh/shapes.hpp"
#include "../mesh/table_scene.hpp"
#include "mesh/load.hpp"
#include "mesh/save.hpp"
#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::json;
namespace scene = mesh::test;

/// A table with two pieces that hang together with it, and a scan of two whole balls with a crumb.
struct SplitCommand : public ::testing::Test {
  SplitCommand() {
    mesh::Mesh on_table = scene::relief([](float x, float y) {
      return std::max({0.0F, 30.0F - std::hypot(x + 40, y), 20.0F - std::hypot(x - 40, y)});
    });
    on_table.colours.resize(on_table.vertices.size(), {200, 100, 50});
    mesh::save(table, on_table);
    mesh::save(balls, scene::together(scene::together(scene::icosphere(20, 3),
                                                      scene::moved(scene::icosphere(10, 2), {50, 0, 0})),
                                      scene::moved(scene::icosphere(1, 0), {0, 60, 0})));
  }

  std::vector<std::string> names_in(const std::string& sub) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder / sub))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  const TemporaryFolder folder;
  const std::string table = folder / "table.ply";
  const std::string balls = folder / "balls.ply";
  const std::string out = folder / "out";
};

TEST_F(SplitCommand, GivesEveryPieceAFileAndTellsWhatWasCutAndLeftOut) {
  const Finished finished =
      run({"split", table, balls, "--out", out, "--json", folder / "s.json", "--png", folder / "s.png"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.err, "");
  EXPECT_EQ(names_in("out"),
            (std::vector<std::string>{"balls_1.ply", "balls_2.ply", "table_1.ply", "table_2.ply"}));
  EXPECT_NE(finished.out.find("2 pieces; cut off the table ("), std::string::npos) << finished.out;
  EXPECT_NE(finished.out.find("2 pieces, no table; left out 1 crumb (20 faces, "), std::string::npos)
      << finished.out;

  const json result = json::parse(read_file(folder / "s.json"));
  EXPECT_EQ(result["schema"], "rejoin.split/1");
  EXPECT_TRUE(result.contains("version"));
  ASSERT_EQ(result["scans"].size(), 2U);
  EXPECT_EQ(result["scans"][0]["path"], table);
  EXPECT_GT(result["scans"][0]["table"]["share"], 0.7);
  EXPECT_TRUE(result["scans"][1]["table"].is_null());
  EXPECT_EQ(result["scans"][1]["crumbs"]["parts"], 1);
  for (const json& scan : result["scans"]) {
    for (const json& piece : scan["pieces"]) {
      const mesh::Mesh read = mesh::load(folder / ("out/" + piece["file"].get<std::string>())).mesh;
      EXPECT_EQ(piece["faces"], read.faces.size());
      EXPECT_EQ(piece["points"], read.vertices.size());
      EXPECT_NEAR(piece["area"].get<double>(), mesh::surface_area(read), 1e-3 * mesh::surface_area(read));
      EXPECT_FLOAT_EQ(piece["bounds"][1][2].get<float>(), mesh::bounds(read).high.z);
    }
  }
  const mesh::Mesh largest = mesh::load(folder / "out/table_1.ply").mesh;
  ASSERT_EQ(largest.colours.size(), largest.vertices.size());
  EXPECT_EQ(largest.colours[0], glm::u8vec3(200, 100, 50));
  EXPECT_EQ(read_file(folder / "s.png").substr(1, 3), "PNG");
}

TEST_F(SplitCommand, OnePieceWithoutATableIsToldAndWritten) {
  mesh::save(folder / "one.ply", scene::icosphere(20, 3));
  const Finished finished = run({"split", folder / "one.ply", "--out", out});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find("1 piece and no table: nothing to split"), std::string::npos) << finished.out;
  EXPECT_NE(finished.out.find("say --table yes"), std::string::npos) << finished.out;
  const mesh::Mesh whole = mesh::load(folder / "one.ply").mesh;
  const mesh::Mesh written = mesh::load(folder / "out/one_1.ply").mesh;
  EXPECT_EQ(written.vertices, whole.vertices);
  EXPECT_EQ(written.faces, whole.faces);
}

TEST_F(SplitCommand, OnePieceBesideCrumbsIsToldWithoutAdviceThatWasTaken) {
  const Finished finished = run({"split", balls, "--out", out, "--least", "70", "--table", "no"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find("1 piece, no table; left out 2 crumbs ("), std::string::npos) << finished.out;
  EXPECT_EQ(finished.out.find("--table"), std::string::npos) << finished.out;
}

TEST_F(SplitCommand, PiecesThatTouchAreToldByName) {
  mesh::save(folder / "two.ply", scene::relief([](float x, float y) {
               const float bridge = std::abs(x) < 15 && std::abs(y) < 15 ? 4.0F : 0.0F;
               return std::max({bridge, 30.0F - std::hypot(x + 38, y), 30.0F - std::hypot(x - 38, y)});
             }));
  const Finished finished = run({"split", folder / "two.ply", "--out", out, "--json", folder / "s.json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("two_1.ply may be pieces that touch"), std::string::npos) << finished.err;
  EXPECT_EQ(json::parse(read_file(folder / "s.json"))["scans"][0]["warnings"].size(), 1U);
}

TEST_F(SplitCommand, CloudsArePartedAndDrawnWithoutNormals) {
  mesh::Mesh cloud =
      scene::together(scene::sphere_cloud(20, 1, 1), scene::moved(scene::sphere_cloud(15, 1, 2), {50, 0, 0}));
  cloud.normals.clear();
  mesh::save(folder / "cloud.ply", cloud);
  const Finished finished = run({"split", folder / "cloud.ply", "--out", out, "--png", folder / "c.png"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(names_in("out"), (std::vector<std::string>{"cloud_1.ply", "cloud_2.ply"}));
  EXPECT_EQ(read_file(folder / "out/cloud_1.ply").find("property float nx"), std::string::npos);
  EXPECT_EQ(read_file(folder / "c.png").substr(1, 3), "PNG");
}

TEST_F(SplitCommand, AScanThatCannotBeUsedIsToldAndTheRestGoesOn) {
  write_file(folder / "bad.ply", "ply\n");
  const Finished finished = run({"split", folder / "bad.ply", balls, "--out", out, "--json", "-"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.err.find("bad.ply: "), std::string::npos) << finished.err;
  EXPECT_EQ(names_in("out"), (std::vector<std::string>{"balls_1.ply", "balls_2.ply"}));
  const json scans = json::parse(finished.out)["scans"];
  EXPECT_TRUE(scans[0].contains("error"));
  EXPECT_EQ(scans[1]["pieces"].size(), 2U);
}

TEST_F(SplitCommand, TakesNoFolderInUseAndNoTwoScansOfOneName) {
  std::filesystem::create_directory(out);
  write_file(folder / "out/balls_1.ply", "precious");
  const Finished used = run({"split", balls, "--out", out});
  EXPECT_EQ(used.exit_code, 1);
  EXPECT_NE(used.err.find("the folder is not empty"), std::string::npos) << used.err;
  EXPECT_EQ(read_file(folder / "out/balls_1.ply"), "precious");

  const Finished same = run({"split", balls, folder / "balls.obj", "--out", folder / "new"});
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_NE(same.err.find("would have the names of those of"), std::string::npos) << same.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));

  const Finished lost = run({"split", balls, "--out", folder / "new", "--json", balls});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(lost.err.find("is read too and would be lost"), std::string::npos) << lost.err;
}

TEST_F(SplitCommand, TakesNoOutputThatMayReplaceAPiece) {
  for (const std::string& json : {folder / "out/balls_1.ply", folder / "./out/../out/balls_12.ply"}) {
    const Finished lost = run({"split", balls, "--out", out, "--json", json});
    EXPECT_EQ(lost.exit_code, 2) << json;
    EXPECT_NE(lost.err.find("has a name that a piece may get"), std::string::npos) << lost.err;
    EXPECT_FALSE(std::filesystem::exists(out));
    std::filesystem::create_directory(out);
    EXPECT_EQ(run({"split", balls, "--out", out, "--json", json}).exit_code, 2)
        << "of a folder that is there";
    std::filesystem::remove(out);
  }
  for (const std::string& json : {folder / "out/balls.json", folder / "balls_1.ply"}) {
    std::filesystem::remove_all(out);
    EXPECT_EQ(run({"split", balls, "--out", out, "--json", json}).exit_code, 0) << json;
  }
}

TEST_F(SplitCommand, ATableThatIsAskedForAndNotThereFails) {
  const Finished finished = run({"split", balls, "--out", out, "--table", "yes"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find("has no plane"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace rejoin::cli::testing
