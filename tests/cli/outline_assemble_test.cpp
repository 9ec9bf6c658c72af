/// rejoin outline assemble, through the program.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "outline_pieces.hpp"

namespace rejoin::cli::testing {
namespace {

TEST(OutlineAssemble, KeepsTwoShapesApartAndPlacesEveryPiece) {
  const BrokenShapes shapes;
  const json assembly = shapes.assembled();
  EXPECT_TRUE(assembly["unplaced"].empty());
  EXPECT_EQ(assembly["joins"].size(), shapes.truth["joins"].size());
  for (const json& join : shapes.truth["joins"]) {
    const std::string a = join[0];
    const std::string b = join[1];
    const json& placed_a = assembly["fragments"][a];
    const json& placed_b = assembly["fragments"][b];
    EXPECT_EQ(placed_a["group"], placed_b["group"]);
    expect_same_motion(product(inverse(matrix_of(placed_a["pose"])), matrix_of(placed_b["pose"])),
                       product(inverse(shapes.world(a)), shapes.world(b)));
  }
  for (const auto& [name, piece] : assembly["fragments"].items()) {
    for (const auto& [other, second] : assembly["fragments"].items()) {
      const bool one_shape =
          shapes.truth["fragments"][name]["object"] == shapes.truth["fragments"][other]["object"];
      EXPECT_EQ(piece["group"] == second["group"], one_shape) << name << " " << other;
    }
  }
}

TEST(OutlineAssemble, ADoubtOfManyFilesIsToldOnce) {
  const TemporaryFolder folder;
  for (int k = 0; k < 5; ++k) {  // each runs out of its picture
    picture(folder, "piece" + std::to_string(k) + ".png", [&](cv::Mat& image) {
      cv::rectangle(image, cv::Rect(0, 0, 30 + 4 * k, 64), cv::Scalar(0), cv::FILLED);
    });
  }
  const Finished done = run({"outline", "assemble", folder / "."});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string doubt = "touches the picture's border";
  EXPECT_NE(done.err.find("piece0.png, "), std::string::npos) << done.err;
  EXPECT_NE(done.err.find("piece1.png and 3 more: "), std::string::npos) << done.err;
  EXPECT_EQ(done.err.find(doubt), done.err.rfind(doubt)) << done.err;
}

// With steps as long as a third of a join nothing tells true from false.
TEST(OutlineAssemble, SearchesWithTheNumbersOfACalibration) {
  const BrokenShapes shapes;
  write_file(shapes / "none.json",
             R"({"schema": "rejoin.outline-calibration/1",
                 "levels": [{"step": 60.0, "xi": 1.2, "zeta": 1.8, "n_min": 5.0}]})");
  const std::string file = shapes / "assembly.json";
  const auto joins = [&](const std::string& method) {
    const Finished done = run({"outline", "assemble", shapes.pieces, "--method", method, "--calibration",
                               shapes / "none.json", "--json", file});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(read_file(file))["joins"].size();
  };
  EXPECT_LT(joins("multiscale"), shapes.truth["joins"].size());
  EXPECT_GT(joins("auto"), joins("multiscale"));  // what is left is compared by emd
  const Finished missing = run({"outline", "assemble", shapes.pieces, "--calibration", shapes / "gone.json"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("gone.json"), std::string::npos) << missing.err;
}

TEST(OutlineAssemble, TellsEveryFileThatItWrites) {
  const BrokenShapes shapes;
  const std::string file = shapes / "assembly.json";
  const std::string pictures = shapes / "pictures";
  const Finished done = run({"outline", "assemble", shapes.pieces, "--json", file, "--out", pictures});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  std::size_t told = 0;
  for (const auto& entry : std::filesystem::directory_iterator(pictures)) {
    EXPECT_NE(done.out.find("wrote " + entry.path().string() + "\n"), std::string::npos) << done.out;
    ++told;
  }
  EXPECT_EQ(told, 6U);  // pieces.png, two objects, two pictures each, and similarity.png
  EXPECT_NE(done.out.find("wrote " + file + "\n"), std::string::npos) << done.out;
}

TEST(OutlineAssemble, LeavesOutWhatTheUserNames) {
  const BrokenShapes shapes;
  const std::string file = shapes / "left_out.json";
  const std::string name = shapes.truth["fragments"].begin().key();
  const Finished done =
      run({"outline", "assemble", shapes.pieces, "--json", file, "--leave-out", name, "--leave-out", name});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json assembly = json::parse(read_file(file));
  EXPECT_FALSE(assembly["fragments"].contains(name));
  ASSERT_EQ(assembly["left_out"].size(), 1U);
  EXPECT_EQ(assembly["left_out"][0]["name"], name);
  const Finished wrong = run({"outline", "assemble", shapes.pieces, "--leave-out", "ruler.csv"});
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_NE(wrong.err.find("'ruler.csv' names no piece"), std::string::npos) << wrong.err;
}

TEST(OutlineAssemble, PicturesOfAnEarlierRunDoNotStay) {
  const BrokenShapes shapes;
  const std::string pictures = shapes / "pictures";
  std::filesystem::create_directory(pictures);
  EXPECT_EQ(run({"outline", "assemble", shapes.pieces, "--out", pictures}).exit_code, 0);
  for (const char* name : {"object_3.png", "joins_12.png", "object_plan.png"})
    std::filesystem::copy_file(pictures + "/object_1.png", pictures + "/" + name);
  write_file(pictures + "/object_2.png", "old");
  write_file(pictures + "/object_30.png", "of the user's own");
  EXPECT_EQ(run({"outline", "assemble", shapes.pieces, "--out", pictures}).exit_code, 0);
  EXPECT_NE(read_file(pictures + "/object_2.png"), "old");
  EXPECT_TRUE(std::filesystem::exists(pictures + "/object_30.png"));
  EXPECT_FALSE(std::filesystem::exists(pictures + "/object_3.png"));
  EXPECT_FALSE(std::filesystem::exists(pictures + "/joins_12.png"));
  EXPECT_TRUE(std::filesystem::exists(pictures + "/object_plan.png"));
}

TEST(OutlineAssemble, PicturesOfTheUsersOwnAmongThePiecesAreNotLost) {
  const BrokenShapes shapes;
  const std::vector<std::string> into_pieces = {"outline", "assemble", shapes.pieces, "--out", shapes.pieces};
  EXPECT_EQ(run(into_pieces).exit_code, 0);
  EXPECT_EQ(run(into_pieces).exit_code, 0) << "its own may be written again";
  for (const char* name : {"object_7.png", "joins_1.png", "pieces.png", "similarity.png"}) {
    const std::string file = shapes.pieces + "/" + name;
    const bool was_there = std::filesystem::exists(file);
    if (was_there) std::filesystem::rename(file, shapes / "kept");
    write_file(file, "a scan");
    const Finished done = run(into_pieces);
    EXPECT_EQ(done.exit_code, 2) << done.err;
    EXPECT_NE(done.err.find(std::string(name) + ": lies among the pieces and would be lost"),
              std::string::npos)
        << done.err;
    EXPECT_EQ(read_file(file), "a scan");
    std::filesystem::remove(file);
    if (was_there) std::filesystem::rename(shapes / "kept", file);
  }
}

TEST(OutlineAssemble, TwoPiecesThatMatchSaysJoinAreJoined) {
  const TemporaryFolder folder;
  const std::string tile = folder / "tile";
  const Finished made = run({"outline", "shatter", tile, "--tiles", "1", "--pieces", "8", "--resolution",
                             "100", "--wear", "1", "--seed", "4"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string two = folder / "two";
  std::filesystem::create_directory(two);
  for (const char* name : {"piece_004.csv", "piece_006.csv"})  // their join is a twelfth of their borders
    std::filesystem::copy_file(tile + "/" + name, two + "/" + name);
  const Finished match = run({"outline", "match", two + "/piece_004.csv", two + "/piece_006.csv"});
  EXPECT_TRUE(match.out.starts_with("join,")) << match.out;
  const Finished done = run({"outline", "assemble", two});
  EXPECT_NE(done.out.find("2 of 2 pieces placed; 1 join"), std::string::npos) << done.out;
}

TEST(OutlineAssemble, APieceThatFitsNowhereMayLieUpsideDownAsOneMethodAloneWouldFind) {
  const BrokenShapes shapes;
  write_file(shapes.pieces + "/square.csv", "x,y\n0,0\n90,0\n90,90\n0,90\n");
  const std::string hint = "upside down fits nowhere either; --method lcs";
  const Finished done = run({"outline", "assemble", shapes.pieces});
  EXPECT_NE(done.out.find("fits nowhere: square.csv\n  what lies " + hint), std::string::npos) << done.out;
  const Finished by_lcs = run({"outline", "assemble", shapes.pieces, "--method", "lcs"});
  EXPECT_NE(by_lcs.out.find("fits nowhere: square.csv"), std::string::npos) << by_lcs.out;
  EXPECT_EQ(by_lcs.out.find(hint), std::string::npos) << by_lcs.out;
}

TEST(OutlineAssemble, AFileThatCannotBeUsedIsToldAndTheRestGoesOn) {
  const BrokenShapes shapes;
  const json without = shapes.assembled();
  write_file(shapes.pieces + "/bad.png", "no picture");
  const std::string file = shapes / "rest.json";
  const Finished done = run({"outline", "assemble", shapes.pieces, "--json", file});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_NE(done.err.find("bad.png: is no PNG"), std::string::npos) << done.err;
  EXPECT_NE(done.err.find("1 of the folder's files cannot be used"), std::string::npos) << done.err;
  const json rest = json::parse(read_file(file));
  EXPECT_EQ(rest["fragments"], without["fragments"]);
  EXPECT_EQ(rest["joins"], without["joins"]);
  ASSERT_EQ(rest["unusable"].size(), 1U);
  EXPECT_EQ(rest["unusable"][0]["name"], "bad.png");
  EXPECT_EQ(rest["unplaced"], json::array({"bad.png"}));
}

/// Adds another scan of a piece.
/// \param side  -1: of its other side
void scan_again(const BrokenShapes& shapes, double side) {
  std::istringstream points(read_file(shapes.pieces + "/piece_001.csv"));
  std::ostringstream turned;
  for (std::string line; std::getline(points, line);) {
    double x = 0.0;
    double y = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf", &x, &y) == 2)
      turned << 0.6 * x - side * 0.8 * y + 70.0 << ',' << 0.8 * x + side * 0.6 * y << '\n';
  }
  write_file(shapes.pieces + "/turned.csv", turned.str());
}

TEST(OutlineAssemble, OtherSideOfAPieceIsTold) {
  const BrokenShapes shapes;
  scan_again(shapes, -1.0);
  const std::string file = shapes / "assembly.json";
  const Finished done = run({"outline", "assemble", shapes.pieces, "--json", file});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const json expected = {{"name", "turned.csv"}, {"of", "piece_001.csv"}, {"turned_over", true}};
  EXPECT_EQ(json::parse(read_file(file))["congruent"], json::array({expected}));
  EXPECT_NE(done.out.find("turned.csv (has the outline of piece_001.csv turned over"), std::string::npos)
      << done.out;
  const Finished pair =
      run({"outline", "match", shapes.pieces + "/turned.csv", shapes.pieces + "/piece_001.csv"});
  EXPECT_NE(pair.err.find("may be two sides of one piece"), std::string::npos) << pair.err;
}

TEST(OutlineAssemble, AnotherScanOfAPieceIsToldWhereItHasNoPlace) {
  const BrokenShapes shapes;
  scan_again(shapes, 1.0);
  const std::string file = shapes / "assembly.json";
  const Finished done = run({"outline", "assemble", shapes.pieces, "--json", file});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const json assembly = json::parse(read_file(file));
  EXPECT_EQ(assembly["schema"], "rejoin.outline-assembly/1");
  ASSERT_EQ(assembly["unplaced"].size(), 1U);
  ASSERT_EQ(assembly["congruent"].size(), 1U);
  const std::string left_over = assembly["congruent"][0]["name"];
  const std::string placed = left_over == "turned.csv" ? "piece_001.csv" : "turned.csv";
  EXPECT_EQ(assembly["unplaced"][0], left_over);
  EXPECT_EQ(assembly["congruent"][0]["of"], placed);
  EXPECT_NE(done.out.find("fits nowhere: " + left_over + " (has the outline of " + placed), std::string::npos)
      << done.out;
}

TEST(OutlineAssemble, ACopyOfAPieceIsToldAndLeftOut) {
  const BrokenShapes shapes;
  const json without = shapes.assembled();
  std::filesystem::copy_file(shapes.pieces + "/piece_001.csv", shapes.pieces + "/piece_001 copy.csv");
  const std::string file = shapes / "with.json";
  const Finished done = run({"outline", "assemble", shapes.pieces, "--json", file});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string told =
      "piece_001.csv and piece_001 copy.csv are the same outline; piece_001 copy.csv is left out";
  EXPECT_NE(done.err.find(told), std::string::npos) << done.err;
  const json with = json::parse(read_file(file));
  EXPECT_EQ(with["fragments"], without["fragments"]);
  ASSERT_EQ(with["repeated"].size(), 1U);
  EXPECT_EQ(with["repeated"][0]["name"], "piece_001 copy.csv");
  EXPECT_EQ(with["unplaced"], json::array({"piece_001 copy.csv"}));
  EXPECT_EQ(with["joins"], without["joins"]);
}

/// An assembly that is interrupted in its search: hundreds of borders to compare take long enough for the signal to arrive there.
struct InterruptedAssembly {
  TemporaryFolder folder;
  std::string json_file = folder / "assembly.json";
  std::string pictures = folder / "pictures";

  Finished run_it() const {
    const std::string pieces = folder / "pieces";
    const Finished made =
        run({"outline", "shatter", pieces, "--shapes", "20", "--pieces", "200", "--resolution", "25"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    Running running({"outline", "assemble", pieces, "--json", json_file, "--out", pictures, "--verbose"});
    EXPECT_TRUE(running.wait_for_stderr("prepared after"));
    running.interrupt();
    Finished finished = running.finish();
    EXPECT_EQ(finished.exit_code, 130) << finished.err;
    return finished;
  }
};

TEST(OutlineAssemble, AfterCtrlCTellsWhichPiecesWereNotTried) {
  const InterruptedAssembly interrupted;
  const Finished finished = interrupted.run_it();
  EXPECT_NE(finished.err.find("interrupted"), std::string::npos) << finished.err;
  const json assembly = json::parse(read_file(interrupted.json_file));
  EXPECT_TRUE(assembly["search"]["interrupted"].get<bool>());
  ASSERT_FALSE(assembly["untried"].empty());
  for (const std::string name : assembly["untried"]) {
    EXPECT_NE(std::find(assembly["unplaced"].begin(), assembly["unplaced"].end(), name),
              assembly["unplaced"].end())
        << name;
    EXPECT_NE(finished.out.find("not tried with all others: " + name), std::string::npos) << finished.out;
  }
}

TEST(OutlineAssemble, AfterCtrlCAnEarlierAssemblyStays) {
  const InterruptedAssembly interrupted;
  write_file(interrupted.json_file, "old");
  std::filesystem::create_directory(interrupted.pictures);
  write_file(interrupted.pictures + "/object_1.png", "old");
  const Finished finished = interrupted.run_it();
  EXPECT_EQ(read_file(interrupted.json_file), "old");
  EXPECT_EQ(read_file(interrupted.pictures + "/object_1.png"), "old");
  EXPECT_NE(finished.err.find(interrupted.json_file + " is kept"), std::string::npos) << finished.err;
}

TEST(OutlineAssemble, AFolderOfNothingUsableIsRefusedWithTheReason) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "bad");
  write_file(folder / "bad/one.png", "no picture");
  expect_refusal({"outline", "assemble", folder / "bad"}, "one.png: is no PNG");
}

TEST(OutlineAssemble, AFolderWithoutPiecesIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "empty");
  expect_refusal({"outline", "assemble", folder / "empty"}, "holds no picture");
  write_file(folder / "empty/b.dxf", "0");
  expect_refusal({"outline", "assemble", folder / "empty"}, "no outline, but b.dxf; put png");
  write_file(folder / "empty/a.json", "{}");
  expect_refusal({"outline", "assemble", folder / "empty"},
                 "no outline, but a.json and 1 other file; put png");
}

TEST(OutlineAssemble, AFileOfAnotherKindIsRefusedAsThat) {
  const TemporaryFolder folder;
  write_file(folder / "drawing.dxf", "0");
  expect_refusal({"outline", "assemble", folder / "drawing.dxf"}, "is neither a picture nor an outline");
  write_file(folder / "pages.pdf", "%PDF");
  expect_refusal({"outline", "assemble", folder / "pages.pdf"}, "is a picture of a kind that is not read");
}

TEST(OutlineAssemble, GeoJsonMayEndInJsonWhereItIsGivenByItself) {
  const TemporaryFolder folder;
  write_file(folder / "two.json",
             R"({"type": "MultiPolygon", "coordinates": [[[[0, 0], [400, 0], [400, 300], [50, 350], [0, 0]]],
                 [[[500, 0], [900, 0], [900, 200], [550, 250], [500, 0]]]]})");
  const Finished done = run({"outline", "assemble", folder / "two.json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.out.find("of 2 pieces placed"), std::string::npos) << done.out;
}

}  // namespace
}  // namespace rejoin::cli::testing
