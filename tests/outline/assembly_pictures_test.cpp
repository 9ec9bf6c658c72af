#include "outline/assembly_pictures.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "outline/pieces_picture.hpp"

namespace rejoin::outline {
namespace {

namespace fs = std::filesystem;

class AssemblyPictures : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("rejoin-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A piece of 40 x 30 pixels in one colour on a larger transparent picture.
  Piece coloured(const std::string& name, const cv::Scalar& bgr) const {
    cv::Mat image(50, 60, CV_8UC4, cv::Scalar(0, 0, 0, 0));
    cv::rectangle(image, cv::Rect(10, 10, 40, 30), cv::Scalar(bgr[0], bgr[1], bgr[2], 255), cv::FILLED);
    Piece piece;
    piece.name = name;
    piece.path = (folder_ / name).string();
    cv::imwrite(piece.path, image);
    piece.outline.points = {{9.5, 9.5}, {49.5, 9.5}, {49.5, 39.5}, {9.5, 39.5}};
    return piece;
  }

  fs::path folder_;
};

/// Two pieces side by side, the second turned over by half a turn.
Assembly side_by_side() {
  Assembly assembly;
  assembly.placements = {{Planar{}, 0, 0.9}, {Planar{M_PI, {99.0, 49.0}, false}, 0, 0.9}};
  assembly.joins = {{0, 1, 0.9, 30.0, false, {}}};
  return assembly;
}

TEST_F(AssemblyPictures, SheetShowsEveryPieceWithItsOutlineOverIt) {
  Piece plain = coloured("b.png", {0, 0, 0});
  plain.path = "outlines.csv";
  write_pieces_picture(folder_ / "pieces.png", {coloured("a.png", {200, 160, 60}), plain});
  const cv::Mat sheet = cv::imread((folder_ / "pieces.png").string());
  ASSERT_EQ(sheet.cols, 2 * sheet.rows);  // a cell for each
  const int cell = sheet.rows;
  EXPECT_EQ(sheet.at<cv::Vec3b>(cell / 2 - 11, cell / 2), cv::Vec3b(200, 160, 60));
  for (int k = 0; k < 2; ++k) {
    cv::Mat blue;
    cv::Mat red;
    cv::extractChannel(sheet(cv::Rect(k * cell, 0, cell, cell)), blue, 0);
    cv::extractChannel(sheet(cv::Rect(k * cell, 0, cell, cell)), red, 2);
    red = red - blue > 40;  // drawn between pixels, so with what lies below
    // The border, 40 by 30, fills 0.86 of the cell's width but for its margin.
    const cv::Rect box = cv::boundingRect(red);
    EXPECT_NEAR(static_cast<double>(box.width) / box.height, 40.0 / 30.0, 0.05) << k;
    EXPECT_GT(box.width, 0.7 * cell) << k;
  }
}

/// Bytes that this process has read so far.
std::size_t bytes_read() {
  std::ifstream file("/proc/self/io");
  std::string word;
  std::size_t bytes = 0;
  EXPECT_TRUE(file >> word >> bytes && word == "rchar:") << "the kernel does not tell what a process reads";
  return bytes;
}

TEST_F(AssemblyPictures, ReadsAScanOnceForAllItsPieces) {
  constexpr int kPieces = 12;
  cv::Mat scan(400, 50 * kPieces, CV_8UC3);
  cv::randu(scan, cv::Scalar::all(0), cv::Scalar::all(255));
  Piece piece = coloured("scan.png", {0, 0, 0});
  cv::imwrite(piece.path, scan);
  std::vector<Piece> pieces;
  Assembly assembly;
  for (int k = 0; k < kPieces; ++k) {
    const double x = 50.0 * k;
    piece.outline.points = {{x, 10.0}, {x + 45.0, 10.0}, {x + 45.0, 390.0}, {x, 390.0}};
    pieces.push_back(piece);
    assembly.placements.push_back({Planar{}, 0, 0.9});
  }
  const std::size_t start = bytes_read();
  write_assembly_pictures(folder_, pieces, assembly);
  EXPECT_LT(bytes_read() - start, 3 * fs::file_size(piece.path));
}

TEST_F(AssemblyPictures, AScanMayBeLongerThanOpenCvTakes) {
  // A strip of 40,000 pixels, red from the 30,000th on.
  cv::Mat scan(20, 40000, CV_8UC3, cv::Scalar(200, 160, 60));
  scan.colRange(30000, 40000) = cv::Scalar(0, 0, 200);
  Piece piece = coloured("long.png", {0, 0, 0});
  cv::imwrite(piece.path, scan);
  piece.outline.points = {{1000.0, 2.0}, {39000.0, 2.0}, {39000.0, 17.0}, {1000.0, 17.0}};
  Assembly assembly;
  assembly.placements = {{Planar{}, 0, 0.9}, {Planar{0.0, {0.0, 15.0}, false}, 0, 0.9}};
  write_assembly_pictures(folder_, {piece, piece}, assembly, {.longest_side = 3800});
  write_pieces_picture(folder_ / "pieces.png", {piece});
  const cv::Mat object = cv::imread((folder_ / "object_1.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_GT(object.cols, 3000);
  int reds = 0;
  int seen = 0;
  for (int x = 0; x < object.cols; ++x) {
    const auto pixel = object.at<cv::Vec4b>(object.rows / 2, x);
    if (pixel[3] < 200) continue;
    ++seen;
    reds += pixel[2] > pixel[0] ? 1 : 0;
  }
  EXPECT_NEAR(reds / static_cast<double>(seen), 9000.0 / 38000.0, 0.001);
}

TEST_F(AssemblyPictures, WhatLiesUnderTransparentPixelsIsNowhereSeen) {
  Piece piece = coloured("a.png", {200, 220, 210});
  Assembly assembly = side_by_side();
  // Turned, so that every pixel of the border is a mean of some of the picture's.
  assembly.placements[1].pose = Planar{0.3, {49.0, 3.0}, false};
  for (const int side : {4000, 40}) {
    write_assembly_pictures(folder_, {piece, piece}, assembly, {.longest_side = side});
    const cv::Mat object = cv::imread((folder_ / "object_1.png").string(), cv::IMREAD_UNCHANGED);
    for (int y = 0; y < object.rows; ++y) {
      for (int x = 0; x < object.cols; ++x) {
        const auto pixel = object.at<cv::Vec4b>(y, x);
        if (pixel[3] < 8) continue;  // so little of a colour is rounded
        EXPECT_NEAR(pixel[0], 200, 3) << x << " " << y;
        EXPECT_NEAR(pixel[1], 220, 3) << x << " " << y;
      }
    }
  }
  write_pieces_picture(folder_ / "pieces.png", {piece});
  const cv::Mat sheet = cv::imread((folder_ / "pieces.png").string());
  EXPECT_EQ(sheet.at<cv::Vec3b>(sheet.rows / 2 - 11, 11), cv::Vec3b(255, 255, 255));
}

TEST_F(AssemblyPictures, KeepTheColoursAndAreTransparentOutside) {
  const std::vector<Piece> pieces = {coloured("a.png", {0, 0, 200}), coloured("b.png", {180, 20, 0})};
  write_assembly_pictures(folder_, pieces, side_by_side());
  const cv::Mat object = cv::imread((folder_ / "object_1.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(object.type(), CV_8UC4);
  EXPECT_EQ(object.cols, 80 + 17);
  EXPECT_EQ(object.rows, 30 + 17);
  EXPECT_EQ(object.at<cv::Vec4b>(1, 1)[3], 0);
  EXPECT_EQ(object.at<cv::Vec4b>(23, 20), cv::Vec4b(0, 0, 200, 255));
  EXPECT_EQ(object.at<cv::Vec4b>(23, 75), cv::Vec4b(180, 20, 0, 255));
}

TEST_F(AssemblyPictures, ShowTheCommonBoundaryInRed) {
  const std::vector<Piece> pieces = {coloured("a.png", {0, 0, 200}), coloured("b.png", {180, 20, 0})};
  write_assembly_pictures(folder_, pieces, side_by_side());
  const cv::Mat joins = cv::imread((folder_ / "joins_1.png").string(), cv::IMREAD_UNCHANGED);
  const cv::Vec4b line = joins.at<cv::Vec4b>(23, 48);  // the common side is at x = 8 + 40
  EXPECT_GT(line[2], 150);
  EXPECT_LT(line[0], 120);
  EXPECT_EQ(joins.at<cv::Vec4b>(1, 1), cv::Vec4b(255, 255, 255, 255));
}

TEST_F(AssemblyPictures, NameEveryNumberBesideThePieces) {
  std::vector<Piece> pieces = {coloured("a.png", {0, 0, 200}), coloured("b.png", {180, 20, 0})};
  const auto ink_beside = [&](int from_row, int to_row) {
    write_assembly_pictures(folder_, pieces, side_by_side());
    const cv::Mat joins = cv::imread((folder_ / "joins_1.png").string());
    const int object = 80 + 17;
    EXPECT_EQ(joins.rows, 30 + 17);
    if (joins.cols <= object) return 0;
    cv::Mat grey;
    cv::cvtColor(joins(cv::Rect(object, from_row, joins.cols - object, to_row - from_row)), grey,
                 cv::COLOR_BGR2GRAY);
    return cv::countNonZero(grey < 128);
  };
  const int first = ink_beside(0, 22);
  const int second = ink_beside(22, 47);
  EXPECT_GT(first, 20);
  EXPECT_GT(second, 20);
  pieces[1].name = "a longer name.png";
  EXPECT_EQ(ink_beside(0, 22), first);
  EXPECT_GT(ink_beside(22, 47), second + 20);
}

TEST_F(AssemblyPictures, ShowNorthUp) {
  // Narrow in the north, wide in the south.
  Piece piece;
  piece.name = piece.path = "a.csv";
  piece.outline.points = {{0, 0}, {100, 0}, {60, 100}, {40, 100}};
  const auto widths = [](const cv::Mat& image, const cv::Scalar& low, const cv::Scalar& high) {
    cv::Mat shown;
    cv::inRange(image, low, high, shown);
    const cv::Rect box = cv::boundingRect(shown);
    const auto at = [&](double share) {
      return cv::countNonZero(shown.row(box.y + static_cast<int>(share * box.height)));
    };
    return std::pair(at(0.1), at(0.9));
  };
  for (const bool up : {true, false}) {
    piece.y_up = up;
    const cv::Mat object = cv::imdecode(assembled_png({piece}, {Planar{}}), cv::IMREAD_UNCHANGED);
    const auto [top, bottom] = widths(object, {0, 0, 0, 128}, {255, 255, 255, 255});
    EXPECT_EQ(top < bottom, up);
    write_pieces_picture(folder_ / "pieces.png", {piece});
    const cv::Mat sheet = cv::imread((folder_ / "pieces.png").string());
    cv::Mat red;
    cv::inRange(sheet, cv::Scalar(0, 0, 180), cv::Scalar(140, 140, 255), red);
    const cv::Rect box = cv::boundingRect(red);
    const auto ends = [&](int y) {
      std::vector<cv::Point> points;
      cv::findNonZero(red(cv::Rect(box.x, y - 4, box.width, 9)), points);
      return cv::boundingRect(points).width;
    };
    EXPECT_EQ(ends(box.y + box.height / 10) < ends(box.y + box.height * 9 / 10), up);
  }
}

TEST_F(AssemblyPictures, NumbersLieOnTheirPieces) {
  // Two bent pieces around one middle.
  Piece left;
  left.name = left.path = "left.csv";
  left.outline.points = {{0, 0}, {100, 0}, {100, 20}, {20, 20}, {20, 100}, {0, 100}};
  Piece right = left;
  right.name = right.path = "right.csv";
  Assembly assembly;
  assembly.placements = {{Planar{}, 0, 0.9}, {Planar{M_PI, {130, 130}, false}, 0, 0.9}};
  write_assembly_pictures(folder_, {left, right}, assembly, {.drawn_side = 400});
  const cv::Mat joins = cv::imread((folder_ / "joins_1.png").string(), cv::IMREAD_GRAYSCALE);
  const double scale = 400.0 / 130.0;
  const auto ink = [&](double x, double y, double side) {
    const cv::Rect box(static_cast<int>(8 + x * scale), static_cast<int>(8 + y * scale),
                       static_cast<int>(side * scale), static_cast<int>(side * scale));
    return cv::countNonZero(joins(box) < 128);
  };
  EXPECT_EQ(ink(30, 30, 70), 0) << "the boxes' middles, on no piece";
  EXPECT_GT(cv::countNonZero(joins(cv::Rect(0, 0, 416, 416)) < 128), 20);
}

TEST_F(AssemblyPictures, TellThatAPieceIsGone) {
  const std::vector<Piece> pieces = {coloured("a.png", {0, 0, 200}), coloured("b.png", {180, 20, 0})};
  fs::remove(pieces[1].path);
  EXPECT_THROW(write_assembly_pictures(folder_, pieces, side_by_side()), Error);
}

}  // namespace
}  // namespace rejoin::outline
