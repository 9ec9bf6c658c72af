/// rejoin outline match and calibrate, through the program.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "outline_pieces.hpp"

namespace rejoin::cli::testing {
namespace {

TEST(OutlineMatch, FindsAPlantedJoinAndDrawsIt) {
  const BrokenShapes shapes;
  const json join = shapes.truth["joins"][0];
  const std::string a = join[0];
  const std::string b = join[1];
  const std::string file = shapes / "match.json";
  const std::string pictures = shapes / "pictures";
  const std::vector<std::string> words{
      "outline", "match", shapes.pieces + "/" + a, shapes.pieces + "/" + b, "--json", file,
      "--out",   pictures};
  const Finished found = run(words);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(run(words).exit_code, 0) << "the first run's pictures are its own to replace";
  const json match = json::parse(read_file(file));
  EXPECT_EQ(match["verdict"], "join");
  EXPECT_EQ(match["search"]["method"], "multiscale");
  expect_same_motion(matrix_of(match["pose"]), product(inverse(shapes.world(a)), shapes.world(b)));
  EXPECT_FALSE(cv::imread(pictures + "/match.png").empty());
  for (const std::string& written : {file, pictures + "/match.png", pictures + "/joined.png"})
    EXPECT_NE(found.out.find("wrote " + written + "\n"), std::string::npos) << found.out;
  EXPECT_EQ(cv::imread(pictures + "/joined.png", cv::IMREAD_UNCHANGED).channels(), 4);
}

TEST(OutlineMatch, APieceAndItsCopyAreToldAndNoJoin) {
  const BrokenShapes shapes;
  const std::string a = shapes.pieces + "/piece_001.csv";
  const std::string copy = shapes / "copy.csv";
  write_file(copy, read_file(a) + "\n");  // the same bytes would be refused
  const std::string file = shapes / "match.json";
  const Finished done = run({"outline", "match", a, copy, "--json", file});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.err.find("piece_001.csv and copy.csv are the same piece"), std::string::npos) << done.err;
  const json match = json::parse(read_file(file));
  EXPECT_EQ(match["verdict"], "no join");
  EXPECT_TRUE(match["pose"].is_null());
}

TEST(OutlineMatch, TellsWhereAPieceLiesAndWhatItsFileCallsIt) {
  const TemporaryFolder folder;
  const auto square = [&](const std::string& name, const std::string& properties, const std::string& low,
                          const std::string& high) {
    write_file(folder / name, R"({"type": "Feature", )" + properties +
                                  R"("geometry": {"type": "Polygon", "coordinates": [[[)" + low + ", 0], [" +
                                  high + ", 0], [" + high + ", 5], [" + low + ", 8]]]}}");
    return folder / name;
  };
  const std::string a = square("a.geojson", R"("properties": {"name": "Uri"}, )", "100", "104");
  const std::string b = square("b.geojson", "", "200", "204");
  const Finished done = run({"outline", "match", a, b, "--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json match = json::parse(done.out);
  EXPECT_EQ(match["a"]["label"], "Uri");
  EXPECT_FALSE(match["b"].contains("label"));
  EXPECT_GT(match["a"]["inside"][0], 100.0);
  EXPECT_LT(match["a"]["inside"][0], 104.0);
  EXPECT_GT(match["b"]["inside"][0], 200.0);
}

TEST(OutlineMatch, APictureThatIsCutShortIsRefusedInOneLine) {
  const TemporaryFolder folder;
  const std::string good = good_picture(folder);
  const std::string bytes = read_file(good);
  const std::string cut = folder / "cut.png";
  for (const std::size_t missing : {std::size_t{5}, bytes.size() / 2}) {
    write_file(cut, bytes.substr(0, bytes.size() - missing));
    expect_refusal({"outline", "match", good, cut}, "cut.png: is cut short");
  }
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
  EXPECT_NE(told.err.find("so if that is so, scale fine.tif to 50 %"), std::string::npos) << told.err;
  const Finished same = run({"outline", "match", fine, write("same.tif", 600)});
  EXPECT_EQ(same.err.find("dots"), std::string::npos) << same.err;
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

TEST(OutlineMatch, PicturesOfAnEarlierPairDoNotStay) {
  const TemporaryFolder folder;
  const std::string square = good_picture(folder);
  write_file(folder / "circle.svg", "<svg><circle r='20'/></svg>");
  const std::vector<std::string> without_fit = {"outline",  "match", square,  folder / "circle.svg",
                                                "--method", "lcs",   "--out", folder / ""};
  const Finished none = run(without_fit);
  ASSERT_NE(none.out.find("nothing fits"), std::string::npos) << none.out << none.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "match.png"));
  std::filesystem::copy_file(folder / "match.png", folder / "joined.png");
  EXPECT_EQ(run(without_fit).exit_code, none.exit_code);
  EXPECT_FALSE(std::filesystem::exists(folder / "joined.png"));
  std::filesystem::copy_file(square, folder / "joined.png");
  const Finished over =
      run({"outline", "match", folder / "joined.png", folder / "circle.svg", "--out", folder / ""});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_NE(over.err.find("joined.png: is read too and would be lost"), std::string::npos) << over.err;
}

TEST(OutlineMatch, APictureOfTheUsersOwnIsNotOverwritten) {
  const TemporaryFolder folder;
  const std::string square = good_picture(folder);
  write_file(folder / "circle.svg", "<svg><circle r='20'/></svg>");
  std::filesystem::copy_file(square, folder / "match.png");
  const Finished refused = run({"outline", "match", square, folder / "circle.svg", "--out", folder / ""});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("match.png: is no picture of this program"), std::string::npos) << refused.err;
  EXPECT_EQ(read_file(folder / "match.png"), read_file(square));
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

// Borders of ten thousands of points take long enough for the signal to arrive in the search.
TEST(OutlineMatch, AfterCtrlCAnEarlierMatchStays) {
  const TemporaryFolder folder;
  const std::string pieces = folder / "pieces";
  const Finished made =
      run({"outline", "shatter", pieces, "--shapes", "1", "--pieces", "2", "--resolution", "1500"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string file = folder / "match.json";
  const std::string pictures = folder / "pictures";
  const auto interrupted = [&] {
    Running running({"outline", "match", pieces + "/piece_000.csv", pieces + "/piece_001.csv", "--method",
                     "lcs", "--json", file, "--out", pictures, "--verbose"});
    EXPECT_TRUE(running.wait_for_stderr("read both pieces"));
    running.interrupt();
    Finished finished = running.finish();
    EXPECT_EQ(finished.exit_code, 130) << finished.err;
    return finished;
  };
  interrupted();
  EXPECT_TRUE(json::parse(read_file(file))["search"]["interrupted"].get<bool>()) << "where none is";

  write_file(file, "old");
  write_file(folder / "circle.svg", "<svg><circle r='20'/></svg>");
  ASSERT_NE(
      run({"outline", "match", good_picture(folder), folder / "circle.svg", "--out", pictures}).exit_code, 2);
  const std::string picture = read_file(pictures + "/match.png");
  const Finished finished = interrupted();
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(read_file(pictures + "/match.png"), picture);
  for (const std::string& output : {file, pictures})
    EXPECT_NE(finished.err.find(output + " is kept"), std::string::npos) << finished.err;
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
