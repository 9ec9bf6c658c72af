/// rejoin outline match, assemble and calibrate, through the program.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "run_program.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::json;
using Matrix = std::array<std::array<double, 3>, 3>;

Matrix matrix_of(const json& rows) {
  return rows.get<Matrix>();
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
  return result;
}

/// Of a motion.
Matrix inverse(const Matrix& m) {
  return {{{m[0][0], m[1][0], -m[0][0] * m[0][2] - m[1][0] * m[1][2]},
           {m[0][1], m[1][1], -m[0][1] * m[0][2] - m[1][1] * m[1][2]},
           {0.0, 0.0, 1.0}}};
}

/// The pieces are some hundred pixels across: a hundredth of a radian moves their ends by a few pixels.
void expect_same_motion(const Matrix& found, const Matrix& truth) {
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_NEAR(found[row][0], truth[row][0], 0.01);
    EXPECT_NEAR(found[row][1], truth[row][1], 0.01);
    EXPECT_NEAR(found[row][2], truth[row][2], 5.0);
  }
}

/// Two shapes broken into three pieces each.
struct BrokenShapes {
  TemporaryFolder folder;
  std::string pieces = folder / "pieces";
  json truth;

  BrokenShapes() {
    const Finished made = run({"outline", "shatter", pieces, "--shapes", "2", "--pieces", "6", "--resolution",
                               "25", "--seed", "5"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    truth = json::parse(read_file(pieces + "/truth.json"));
  }

  std::string operator/(const std::string& name) const { return folder / name; }

  Matrix world(const std::string& piece) const { return matrix_of(truth["fragments"][piece]["to_world"]); }

  json assembled() const {
    const std::string file = folder / "assembly.json";
    const Finished done = run({"outline", "assemble", pieces, "--json", file});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(read_file(file));
  }
};

/// A dark square on white, or what `draw` makes of a white picture.
template <typename Draw>
std::string picture(const TemporaryFolder& folder, const std::string& name, const Draw& draw) {
  cv::Mat image(64, 64, CV_8U, cv::Scalar(255));
  draw(image);
  const std::string path = folder / name;
  EXPECT_TRUE(cv::imwrite(path, image));
  return path;
}

std::string good_picture(const TemporaryFolder& folder) {
  return picture(folder, "good.png", [](cv::Mat& image) {
    cv::rectangle(image, cv::Rect(10, 12, 40, 30), cv::Scalar(0), cv::FILLED);
  });
}

/// Refused with exit code 1 and one line that contains `reason`.
void expect_refusal(const std::vector<std::string>& arguments, const std::string& reason) {
  const Finished finished = run(arguments);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
  EXPECT_NE(finished.err.find(reason), std::string::npos) << finished.err;
}

TEST(OutlineMatch, FindsAPlantedJoinAndDrawsIt) {
  const BrokenShapes shapes;
  const json join = shapes.truth["joins"][0];
  const std::string a = join[0];
  const std::string b = join[1];
  const std::string file = shapes / "match.json";
  const std::string pictures = shapes / "pictures";
  const Finished found = run({"outline", "match", shapes.pieces + "/" + a, shapes.pieces + "/" + b, "--json",
                              file, "--out", pictures});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const json match = json::parse(read_file(file));
  EXPECT_EQ(match["verdict"], "join");
  EXPECT_EQ(match["search"]["method"], "multiscale");
  expect_same_motion(matrix_of(match["pose"]), product(inverse(shapes.world(a)), shapes.world(b)));
  EXPECT_FALSE(cv::imread(pictures + "/match.png").empty());
  for (const std::string& written : {file, pictures + "/match.png", pictures + "/joined.png"})
    EXPECT_NE(found.out.find("wrote " + written + "\n"), std::string::npos) << found.out;
  EXPECT_EQ(cv::imread(pictures + "/joined.png", cv::IMREAD_UNCHANGED).channels(), 4);
}

// The shapes' edges are scanned to a fraction of a pixel and each method lays them on each other to about a pixel.
TEST(OutlineMatch, EveryMethodStatesAreasOfAboutHalfAPixelAlongATrueJoin) {
  const BrokenShapes shapes;
  json join = shapes.truth["joins"][0];
  for (const json& other : shapes.truth["joins"])
    if (other[2] > join[2]) join = other;
  for (const char* method : {"multiscale", "lcs", "emd", "frechet"}) {
    const std::string file = shapes / "match.json";
    const Finished found =
        run({"outline", "match", shapes.pieces + "/" + join[0].get<std::string>(),
             shapes.pieces + "/" + join[1].get<std::string>(), "--method", method, "--json", file});
    ASSERT_EQ(found.exit_code, 0) << found.err;
    const json match = json::parse(read_file(file));
    const double length = match["boundary"]["length"];
    EXPECT_NEAR(length, join[2].get<double>(), 0.15 * join[2].get<double>()) << method;
    EXPECT_LT(match["overlap_area"].get<double>(), 0.7 * length) << method;
    EXPECT_LT(match["gap_area"].get<double>(), 0.7 * length) << method;
  }
}

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

TEST(OutlineCalibrate, WhatItWritesIsReadByMatch) {
  const BrokenShapes shapes;
  shapes.assembled();
  const std::string numbers = shapes / "numbers.json";
  const Finished done =
      run({"outline", "calibrate", shapes.pieces, "--joins", shapes / "assembly.json", "--json", numbers});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.out.find("wrote " + numbers + "\n"), std::string::npos) << done.out;
  const json levels = json::parse(read_file(numbers))["levels"];
  ASSERT_GE(levels.size(), 2U);
  double least_mistaken = 1.0;
  for (const json& level : levels) least_mistaken = std::min(least_mistaken, level["mistaken"].get<double>());
  // The best scale tells true from false far better than a coin.
  EXPECT_LT(least_mistaken, 0.25);
  EXPECT_GT(levels[0]["true_candidates"].get<int>(), 0);
  EXPECT_GT(levels[0]["false_candidates"].get<int>(), 0);
  json join = shapes.truth["joins"][0];
  for (const json& other : shapes.truth["joins"])
    if (other[2] > join[2]) join = other;
  const Finished found = run({"outline", "match", shapes.pieces + "/" + join[0].get<std::string>(),
                              shapes.pieces + "/" + join[1].get<std::string>(), "--calibration", numbers});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.out.rfind("join,", 0), 0U) << found.out;
}

// With steps as long as a third of a join nothing tells true from false.
TEST(OutlineAssemble, SearchesWithTheNumbersOfACalibration) {
  const BrokenShapes shapes;
  write_file(shapes / "none.json",
             R"({"schema": "rejoin.outline-calibration/1",
                 "levels": [{"step": 60.0, "xi": 1.2, "zeta": 1.8, "n_min": 5.0}]})");
  const std::string file = shapes / "assembly.json";
  const Finished done =
      run({"outline", "assemble", shapes.pieces, "--calibration", shapes / "none.json", "--json", file});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_LT(json::parse(read_file(file))["joins"].size(), shapes.truth["joins"].size());
  const Finished missing = run({"outline", "assemble", shapes.pieces, "--calibration", shapes / "gone.json"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("gone.json"), std::string::npos) << missing.err;
}

TEST(OutlineMatch, ACalibrationOfAnotherResolutionIsToldAndOneThatCannotFitIsRefused) {
  const BrokenShapes shapes;
  const std::string file = shapes / "numbers.json";
  const std::vector<std::string> command = {
      "outline",       "match", shapes.pieces + "/piece_000.csv", shapes.pieces + "/piece_001.csv",
      "--calibration", file};
  const auto write = [&](const std::string& step, const std::string& xi) {
    write_file(file, R"({"schema": "rejoin.outline-calibration/1", "levels": [{"step": )" + step +
                         R"(, "xi": )" + xi + R"(, "zeta": 1.8, "n_min": 5.0}]})");
  };
  // The pieces' own step is about 1.4 pixels.
  write("1.8", "1.2");
  EXPECT_EQ(run(command).err, "");
  write("22.0", "1.2");
  const Finished coarse = run(command);
  EXPECT_EQ(coarse.exit_code, 0);
  EXPECT_TRUE(is_one_line(coarse.err)) << coarse.err;
  EXPECT_NE(
      coarse.err.find("numbers.json: its finest step of 22 is 15.7 times as coarse as that of these pieces"),
      std::string::npos)
      << coarse.err;
  for (const char* step : {"1e-300", "1e-3", "1e300"}) {
    write(step, "1.2");
    expect_refusal(command, "its finest step of");
  }
  write("1.4", "1e300");
  expect_refusal(command, "a level's \"xi\" is above 1000");
}

TEST(OutlineCalibrate, KeepsTheResolutionThatThePicturesTell) {
  const TemporaryFolder folder;
  const std::string made = folder / "made";
  ASSERT_EQ(run({"outline", "shatter", made, "--shapes", "2", "--pieces", "6", "--resolution", "25", "--seed",
                 "5", "--format", "png"})
                .exit_code,
            0);
  const std::string pieces = folder / "pieces";
  std::filesystem::create_directory(pieces);
  json truth = {{"joins", json::array()}};
  const json of_pngs = json::parse(read_file(made + "/truth.json"));
  const auto renamed = [](const std::string& name) { return name.substr(0, name.size() - 4) + ".tif"; };
  for (const auto& [name, fragment] : of_pngs["fragments"].items())
    truth["fragments"][renamed(name)] = fragment;
  for (const json& join : of_pngs["joins"]) truth["joins"].push_back({renamed(join[0]), renamed(join[1])});
  write_file(pieces + "/truth.json", truth.dump());
  const auto scan_with = [&](int dots) {
    for (const auto& [name, fragment] : of_pngs["fragments"].items())
      cv::imwrite(pieces + "/" + renamed(name), cv::imread(made + "/" + name, cv::IMREAD_UNCHANGED),
                  {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, dots, cv::IMWRITE_TIFF_YDPI, dots});
  };
  scan_with(600);
  const std::string numbers = folder / "numbers.json";
  ASSERT_EQ(run({"outline", "calibrate", pieces, "--json", numbers}).exit_code, 0);
  EXPECT_EQ(json::parse(read_file(numbers))["dots_per_inch"], 600.0);
  const std::vector<std::string> command = {
      "outline", "match", pieces + "/piece_000.tif", pieces + "/piece_001.tif", "--calibration", numbers};
  EXPECT_EQ(run(command).err, "");
  scan_with(300);
  const Finished told = run(command);
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_NE(told.err.find("was made from files of 600 dots an inch, and these have 300"), std::string::npos)
      << told.err;
}

TEST(OutlineMatch, APictureWithoutAPieceIsRefused) {
  const TemporaryFolder folder;
  const std::string blank = picture(folder, "blank.png", [](cv::Mat&) {});
  expect_refusal({"outline", "match", blank, good_picture(folder)}, "no piece stands out");
}

TEST(OutlineMatch, FurtherPiecesOfAPictureHaveNumbers) {
  const TemporaryFolder folder;
  const auto two = [](cv::Mat& image) {
    cv::rectangle(image, cv::Rect(6, 6, 50, 20), cv::Scalar(0), cv::FILLED);
    cv::rectangle(image, cv::Rect(8, 36, 18, 18), cv::Scalar(0), cv::FILLED);
  };
  const std::string scan = picture(folder, "scan.png", two);
  const Finished largest = run({"outline", "match", scan, good_picture(folder)});
  EXPECT_NE(largest.err.find("holds 2 pieces; the largest is taken, " + scan + "#2 is the next"),
            std::string::npos)
      << largest.err;
  const std::string file = folder / "match.json";
  const Finished numbered = run({"outline", "match", scan + "#2", scan + "#1", "--json", file});
  EXPECT_EQ(numbered.exit_code, 0);
  EXPECT_EQ(numbered.err, "");
  const json match = json::parse(read_file(file));
  EXPECT_EQ(match["a"]["name"], "scan.png#2");
  EXPECT_NEAR(match["a"]["area"].get<double>(), 18.0 * 18.0, 20.0);
  EXPECT_NEAR(match["b"]["area"].get<double>(), 50.0 * 20.0, 20.0);
  expect_refusal({"outline", "match", scan + "#3", scan}, "holds 2 pieces");
  EXPECT_NE(run({"outline", "match", scan + "#1", scan}).err.find("is the same file"), std::string::npos);
  EXPECT_EQ(run({"outline", "match", scan + "#2", good_picture(folder), "--json", scan}).exit_code, 2);
  std::filesystem::copy_file(good_picture(folder), folder / "good.png#2.png");
  EXPECT_EQ(run({"outline", "match", folder / "good.png#2.png", scan}).exit_code, 0);
}

TEST(OutlineMatch, HolesAreToldWhereTheMethodComparesNone) {
  const TemporaryFolder folder;
  const std::string holed = picture(folder, "holed.png", [](cv::Mat& image) {
    cv::rectangle(image, cv::Rect(6, 6, 50, 50), cv::Scalar(0), cv::FILLED);
    cv::rectangle(image, cv::Rect(20, 20, 16, 16), cv::Scalar(255), cv::FILLED);
  });
  const std::string other = good_picture(folder);
  EXPECT_EQ(run({"outline", "match", holed, other}).err, "");
  const Finished told = run({"outline", "match", holed, other, "--method", "emd"});
  EXPECT_NE(told.err.find("holed.png has a hole"), std::string::npos) << told.err;
  EXPECT_EQ(run({"outline", "match", other, folder / "holed.png", "--method", "multiscale"}).err, "");
}

TEST(OutlineMatch, APieceThatRunsOutOfThePictureIsTold) {
  const TemporaryFolder folder;
  const std::string cut = picture(folder, "cut.png", [](cv::Mat& image) {
    cv::rectangle(image, cv::Rect(0, 0, 40, 64), cv::Scalar(0), cv::FILLED);
  });
  const Finished finished = run({"outline", "match", cut, good_picture(folder)});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_NE(finished.err.find("touches the picture's border"), std::string::npos) << finished.err;
}

TEST(OutlineMatch, PicturesOfDifferentResolutionsAreTold) {
  const TemporaryFolder folder;
  cv::Mat image(64, 64, CV_8U, cv::Scalar(255));
  cv::rectangle(image, cv::Rect(10, 12, 40, 30), cv::Scalar(0), cv::FILLED);
  const auto write = [&](const std::string& name, int dots) {
    ++image.at<std::uint8_t>(20, 20);  // no two files are the same
    cv::imwrite(folder / name, image,
                {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, dots, cv::IMWRITE_TIFF_YDPI, dots});
    return folder / name;
  };
  const std::string fine = write("fine.tif", 600);
  const Finished told = run({"outline", "match", fine, write("coarse.tif", 300)});
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_NE(told.err.find("fine.tif says that it has 600 dots or units an inch, coarse.tif 300"),
            std::string::npos)
      << told.err;
  EXPECT_EQ(run({"outline", "match", fine, write("same.tif", 600)}).err, "");
}

TEST(OutlineMatch, AnOutlineOfThreePointsIsRefused) {
  const TemporaryFolder folder;
  write_file(folder / "three.csv", "x,y\n0,0\n10,0\n0,10\n");
  expect_refusal({"outline", "match", folder / "three.csv", good_picture(folder)}, "3 points");
}

TEST(OutlineMatch, APictureThatClaimsToBeHugeIsRefusedByItsHeader) {
  const TemporaryFolder folder;
  std::string bytes = read_file(good_picture(folder));
  // Width and height stand at bytes 16 to 23 of every PNG, most significant byte first: 65536 x 65536.
  for (const std::size_t at : {16U, 20U}) bytes.replace(at, 4, std::string("\0\1\0\0", 4));
  write_file(folder / "huge.png", bytes);
  expect_refusal({"outline", "match", folder / "huge.png", good_picture(folder)}, "120 million");
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

TEST(OutlineAssemble, PicturesOfAnEarlierRunDoNotStay) {
  const BrokenShapes shapes;
  const std::string pictures = shapes / "pictures";
  std::filesystem::create_directory(pictures);
  for (const char* name : {"object_2.png", "object_3.png", "joins_12.png", "object_plan.png"})
    write_file(pictures + "/" + name, "old");
  EXPECT_EQ(run({"outline", "assemble", shapes.pieces, "--out", pictures}).exit_code, 0);
  EXPECT_NE(read_file(pictures + "/object_2.png"), "old");
  EXPECT_FALSE(std::filesystem::exists(pictures + "/object_3.png"));
  EXPECT_FALSE(std::filesystem::exists(pictures + "/joins_12.png"));
  EXPECT_TRUE(std::filesystem::exists(pictures + "/object_plan.png"));
}

TEST(OutlineMatch, PicturesOfAnEarlierPairDoNotStay) {
  const TemporaryFolder folder;
  const std::string square = good_picture(folder);
  write_file(folder / "circle.svg", "<svg><circle r='20'/></svg>");
  write_file(folder / "joined.png", "old");
  const Finished none =
      run({"outline", "match", square, folder / "circle.svg", "--method", "lcs", "--out", folder / ""});
  ASSERT_NE(none.out.find("nothing fits"), std::string::npos) << none.out << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "joined.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "match.png"));
  std::filesystem::copy_file(square, folder / "joined.png");
  const Finished over =
      run({"outline", "match", folder / "joined.png", folder / "circle.svg", "--out", folder / ""});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_NE(over.err.find("joined.png: is read too and would be lost"), std::string::npos) << over.err;
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

// Hundreds of borders to compare take long enough for the signal to arrive in the search.
TEST(OutlineAssemble, AfterCtrlCTellsWhichPiecesWereNotTried) {
  const TemporaryFolder folder;
  const std::string pieces = folder / "pieces";
  const Finished made =
      run({"outline", "shatter", pieces, "--shapes", "20", "--pieces", "200", "--resolution", "25"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string file = folder / "assembly.json";
  Running running({"outline", "assemble", pieces, "--json", file, "--verbose"});
  ASSERT_TRUE(running.wait_for_stderr("prepared after"));
  running.interrupt();
  const Finished finished = running.finish();
  EXPECT_EQ(finished.exit_code, 130) << finished.err;
  EXPECT_NE(finished.err.find("interrupted"), std::string::npos) << finished.err;
  const json assembly = json::parse(read_file(file));
  EXPECT_TRUE(assembly["search"]["interrupted"].get<bool>());
  ASSERT_FALSE(assembly["untried"].empty());
  for (const std::string name : assembly["untried"]) {
    EXPECT_NE(std::find(assembly["unplaced"].begin(), assembly["unplaced"].end(), name),
              assembly["unplaced"].end())
        << name;
    EXPECT_NE(finished.out.find("not tried with all others: " + name), std::string::npos) << finished.out;
  }
}

// A pipe that nobody writes to holds the program inside the reader; opening our end waits until it is there.
TEST(OutlineMatch, CtrlCWhileReadingEndsAtOnceWith130) {
  const BrokenShapes shapes;
  const std::string endless = shapes / "endless.csv";
  ASSERT_EQ(mkfifo(endless.c_str(), 0600), 0);
  Running running({"outline", "match", endless, shapes.pieces + "/piece_001.csv"});
  const std::ofstream our_end(endless);
  running.interrupt();
  const Finished finished = running.finish();
  EXPECT_EQ(finished.exit_code, 130);
  EXPECT_EQ(finished.out, "");
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
}

TEST(OutlineCalibrate, JoinsThatAreNoneAreRefused) {
  const BrokenShapes shapes;
  write_file(shapes / "joins.json", R"({"joins": [3]})");
  expect_refusal({"outline", "calibrate", shapes.pieces, "--joins", shapes / "joins.json", "--json",
                  shapes / "out.json"},
                 "no two names");
}

TEST(OutlineCalibrate, JoinsThatLayNoPieceBesideAnotherAreRefused) {
  const BrokenShapes shapes;
  json far = shapes.truth;
  far["joins"] = json::array({far["joins"][0]});
  double shift = 0.0;
  for (json& fragment : far["fragments"]) fragment["to_world"][0][2] = shift += 1e5;
  write_file(shapes / "far.json", far.dump());
  expect_refusal(
      {"outline", "calibrate", shapes.pieces, "--joins", shapes / "far.json", "--json", shapes / "out.json"},
      "far.json: no scale has ten places");
  EXPECT_FALSE(std::filesystem::exists(shapes / "out.json"));
}

TEST(OutlineMatch, AScanAndAPictureAreWrongUse) {
  const TemporaryFolder folder;
  const std::string flat = good_picture(folder);
  write_file(folder / "scan.ply", "ply\n");
  const Finished finished = run({"outline", "match", flat, folder / "scan.ply"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("two of a kind"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace rejoin::cli::testing
