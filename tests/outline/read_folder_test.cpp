/// Folders of pieces: what is taken, what is left out and told.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "outline/read.hpp"
#include "read_files.hpp"

namespace rejoin::outline {
namespace {

class ReadFolder : public testing::ReadFiles {};

/// A blot with a bump that shows where it is turned to; `bump` in degrees.
cv::Mat blot(double bump) {
  cv::Mat image(200, 220, CV_8UC3, cv::Scalar(240, 240, 240));
  cv::circle(image, {110, 100}, 60, cv::Scalar(40, 60, 120), cv::FILLED, cv::LINE_AA);
  const cv::Point at(110 + static_cast<int>(60 * std::cos(bump * M_PI / 180)),
                     100 + static_cast<int>(60 * std::sin(bump * M_PI / 180)));
  cv::circle(image, at, 15, cv::Scalar(40, 60, 120), cv::FILLED, cv::LINE_AA);
  return image;
}

TEST_F(ReadFolder, OneFileWithAllOfThePiecesIsReadLikeAFolder) {
  write("sheet.svg",
        "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0 H30 V20 H0 Z M50 0 H80 V40 H60 V20 H50 "
        "Z'/></svg>");
  const PieceSet set = read_folder((folder_ / "sheet.svg").string());
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[0].name, "sheet.svg");
  EXPECT_EQ(set.pieces[1].name, "sheet.svg#2");
}

TEST_F(ReadFolder, OnePictureInSeveralFormatsIsOnePiece) {
  cv::Mat deep;
  blot(30).convertTo(deep, CV_16U, 257);
  cv::imwrite((folder_ / "a.png").string(), blot(30));
  cv::imwrite((folder_ / "a copy.tif").string(), deep);
  cv::imwrite((folder_ / "a copy.jpg").string(), blot(30));
  cv::imwrite((folder_ / "b.png").string(), blot(60));
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[0].name, "a.png");
  EXPECT_EQ(set.pieces[1].name, "b.png");
  EXPECT_EQ(set.repeated.size(), 2U);
}

// Noise moves the places at which a contour crosses pixels, and how many there are.
TEST_F(ReadFolder, ANoisyPictureSavedAsJpegIsOnePieceWithIt) {
  cv::Mat noise(200, 220, CV_16SC3);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 6.0);
  cv::Mat picture;
  cv::add(blot(30), noise, picture, cv::noArray(), CV_8U);
  cv::imwrite((folder_ / "a.png").string(), picture);
  cv::imwrite((folder_ / "a copy.jpg").string(), picture, {cv::IMWRITE_JPEG_QUALITY, 90});
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_EQ(set.pieces[0].name, "a.png");
  EXPECT_EQ(set.repeated.size(), 1U);
}

TEST_F(ReadFolder, FolderTellsHowFarItIs) {
  for (const char* name : {"a.csv", "b.csv", "c.csv"}) write(name, "0,0\n9,0\n9,7\n0,8\n");
  std::vector<double> told;
  const Context context([&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "reading pieces");
    told.push_back(fraction);
  });
  EXPECT_FALSE(read_folder(folder_.string(), {}, context).pieces.empty());
  EXPECT_EQ(told, std::vector<double>({0.0, 1.0 / 3.0, 2.0 / 3.0}));
}

TEST_F(ReadFolder, CardsOfOneSizeWithOtherTextAreNoCopies) {
  const auto card = [&](const char* name, const char* text) {
    cv::Mat image(200, 300, CV_8UC3, cv::Scalar(90, 60, 40));
    cv::rectangle(image, {30, 30, 240, 140}, cv::Scalar(215, 230, 236), cv::FILLED);
    cv::putText(image, text, {100, 110}, cv::FONT_HERSHEY_SIMPLEX, 0.5, cv::Scalar(30, 30, 30), 1,
                cv::LINE_AA);
    cv::imwrite((folder_ / name).string(), image);
  };
  card("a.png", "No. 17");
  card("b.png", "No. 18");
  card("b copy.jpg", "No. 18");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  ASSERT_EQ(set.repeated.size(), 1U);
  EXPECT_EQ(set.repeated[0].name, "b copy.jpg");
}

TEST_F(ReadFolder, PicturesThatTellDifferentResolutionsAreDoubted) {
  const auto tiff = [&](const char* name, double bump, int dots) {
    cv::imwrite((folder_ / name).string(), blot(bump),
                {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, dots, cv::IMWRITE_TIFF_YDPI, dots});
  };
  tiff("a.tif", 10, 300);
  tiff("b.tif", 50, 300);
  EXPECT_TRUE(read_folder(folder_.string()).notes.empty());
  // A JPEG of the same 300 dots an inch, told as 118 a centimetre, and then of 200 dots an inch.
  const std::string jpeg = (folder_ / "c.jpg").string();
  for (const auto& [unit, dots, notes] : {std::tuple(2, 118, 0U), std::tuple(1, 200, 1U)}) {
    cv::imwrite(jpeg, blot(90));
    std::fstream file(jpeg, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(13);
    const char bytes[] = {static_cast<char>(unit), 0, static_cast<char>(dots), 0, static_cast<char>(dots)};
    file.write(bytes, sizeof bytes);
    file.close();
    EXPECT_EQ(read_folder(folder_.string()).notes.size(), notes) << unit;
  }
}

TEST_F(ReadFolder, ResolutionOfAJpegMayStandInItsExif) {
  cv::imwrite((folder_ / "a.tif").string(), blot(10),
              {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, 300, cv::IMWRITE_TIFF_YDPI, 300});
  const std::string path = (folder_ / "b.jpg").string();
  for (const char dots : {75, 60}) {
    cv::imwrite(path, blot(50));
    std::string bytes = read_file(path);
    // In the place of the JFIF segment; one entry: tag 0x11A, a ratio that stands behind, `dots` over a quarter.
    std::string exif(
        "\xFF\xE1\0\x2A"
        "Exif\0\0"
        "II*\0\x8\0\0\0"
        "\1\0"
        "\x1A\1\5\0\1\0\0\0\x1A\0\0\0"
        "\0\0\0\0"
        "\0\0\0\0\x1\0\0\0",
        44);
    exif[37] = dots;  // times 256
    exif[40] = 64;
    bytes.replace(2, 18, exif);
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(read_folder(folder_.string()).notes.size(), dots == 75 ? 0U : 1U) << static_cast<int>(dots);
  }
}

TEST_F(ReadFolder, ResultsAndHiddenFilesOfAFolderAreNoPieces) {
  for (const char* name : {"a.png", "object_12.png", "similarity.png"})
    cv::imwrite((folder_ / name).string(), blot(30));
  write("._a.png", "what macOS keeps beside a.png");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_TRUE(set.unusable.empty());
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("2 pictures that rejoin writes"), std::string::npos) << set.notes[0];
}

TEST_F(ReadFolder, PipesAndFoldersWithNamesOfPicturesAreToldAndLeftOut) {
  cv::imwrite((folder_ / "a.png").string(), blot(30));
  std::filesystem::create_directory(folder_ / "folder.png");
  ASSERT_EQ(mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  const PieceSet set = read_folder(folder_.string());
  EXPECT_EQ(set.pieces.size(), 1U);
  ASSERT_EQ(set.unusable.size(), 2U);
  EXPECT_EQ(set.unusable[0].name, "folder.png");
  EXPECT_EQ(set.unusable[1].name, "pipe.png");
  EXPECT_NE(set.unusable[1].reason.find("pipe.png: is a pipe or device; "), std::string::npos);
}

TEST_F(ReadFolder, FoldersOfPiecesAndRawPicturesAreTold) {
  cv::imwrite((folder_ / "a.png").string(), blot(30));
  write("b.NEF", "raw");
  std::filesystem::create_directory(folder_ / "more");
  std::filesystem::create_directory(folder_ / "notes");
  cv::imwrite((folder_ / "more" / "c.png").string(), blot(20));
  cv::imwrite((folder_ / "more" / "pieces.png").string(), blot(20));
  const PieceSet set = read_folder(folder_.string());
  EXPECT_EQ(set.pieces.size(), 1U);
  ASSERT_EQ(set.unusable.size(), 1U);
  EXPECT_EQ(set.unusable[0].name, "b.NEF");
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("more: is a folder with 1 file"), std::string::npos) << set.notes[0];
}

/// A torn piece beside a ruler that lies a little askew, on black.
cv::Mat with_ruler() {
  cv::Mat picture(900, 1200, CV_8UC3, cv::Scalar(20, 20, 20));
  const cv::RotatedRect ruler(cv::Point2f(600, 750), cv::Size2f(900, 120), 2.0F);
  std::array<cv::Point2f, 4> corners;
  ruler.points(corners.data());
  std::vector<cv::Point> polygon(corners.begin(), corners.end());
  cv::fillConvexPoly(picture, polygon, cv::Scalar(240, 240, 240), cv::LINE_AA);
  std::vector<cv::Point> piece;  // nearly a rectangle, but torn
  for (int k = 0; k < 120; ++k) {
    const double at = k / 30.0;
    const int side = static_cast<int>(at);
    const double along = 400.0 * (at - side);
    const double rough = 6.0 * std::sin(9.7 * k) + 300.0;
    const std::array<cv::Point2d, 4> places{{{along, 300.0 - rough},
                                             {400.0 + rough - 300.0, along},
                                             {400.0 - along, rough + 100.0},
                                             {300.0 - rough, 400.0 - along}}};
    piece.emplace_back(300 + static_cast<int>(places[static_cast<std::size_t>(side)].x),
                       120 + static_cast<int>(places[static_cast<std::size_t>(side)].y));
  }
  cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{piece}, cv::Scalar(120, 180, 210), cv::LINE_AA);
  return picture;
}

TEST_F(ReadFolder, RulersBesidePiecesAreLeftOutButNotAlone) {
  const cv::Mat picture = with_ruler();
  cv::imwrite((folder_ / "a.png").string(), blot(50));
  cv::imwrite((folder_ / "b.png").string(), blot(60));
  cv::imwrite((folder_ / "both.png").string(), picture);
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 3U);
  EXPECT_EQ(set.pieces[2].name, "both.png");  // the larger
  ASSERT_EQ(set.left_out.size(), 1U);
  EXPECT_EQ(set.left_out[0].name, "both.png#2");
  ExtractOptions keeping;
  keeping.keep_rectangles = true;
  EXPECT_EQ(read_folder(folder_.string(), keeping).pieces.size(), 4U);
  cv::imwrite((folder_ / "both.png").string(), picture(cv::Rect(0, 600, 1200, 300)));
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 3U);
}

TEST_F(ReadFolder, RulersStayWhereNoTwoPiecesWouldBeLeft) {
  cv::imwrite((folder_ / "both.png").string(), with_ruler());
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 2U);
}

// Two sides of every quarter were torn, by up to three pixels, and two are the page's.
TEST_F(ReadFolder, TornQuartersOfAPageAreNoRulers) {
  cv::Mat page(1100, 1500, CV_8UC3, cv::Scalar(20, 20, 20));
  cv::rectangle(page, cv::Rect(60, 60, 1380, 980), cv::Scalar(240, 240, 240), cv::FILLED);
  for (int k = 0; k < 1500; ++k) {
    const int y = 550 + static_cast<int>(2.0 * std::sin(0.05 * k) + 1.0 * std::sin(0.31 * k));
    cv::line(page, {k, y - 8}, {k, y + 8}, cv::Scalar(20, 20, 20));
    const int x = 750 + static_cast<int>(2.0 * std::cos(0.06 * k) + 1.0 * std::cos(0.37 * k));
    if (k < 1100) cv::line(page, {x - 8, k}, {x + 8, k}, cv::Scalar(20, 20, 20));
  }
  cv::GaussianBlur(page, page, cv::Size(), 0.7);
  cv::imwrite((folder_ / "page.png").string(), page);
  cv::imwrite((folder_ / "another.png").string(), blot(60));
  cv::imwrite((folder_ / "third.png").string(), blot(50));
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 6U);
}

// A clean tear is an even bow, by a fortieth of its length here; a lens bows the side of a ruler by a three hundredth.
TEST_F(ReadFolder, PiecesWithABowedTearAreNoRulers) {
  const auto pieces_with_bow = [&](double bow) {
    cv::Mat picture(900, 1200, CV_8UC3, cv::Scalar(20, 20, 20));
    cv::circle(picture, {250, 650}, 180, cv::Scalar(240, 240, 240), cv::FILLED, cv::LINE_AA);
    std::vector<cv::Point> border{{1100, 100}, {1100, 450}, {500, 450}, {500, 100}};
    for (int x = 501; x < 1100; ++x) {
      const double along = (x - 800) / 300.0;
      border.emplace_back(x, 100 + static_cast<int>(std::lround(bow * 600.0 * (1.0 - along * along))));
    }
    cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{border}, cv::Scalar(240, 240, 240),
                 cv::LINE_AA);
    cv::imwrite((folder_ / "both.png").string(), picture);
    cv::imwrite((folder_ / "a.png").string(), blot(50));
    return read_folder(folder_.string()).pieces.size();
  };
  EXPECT_EQ(pieces_with_bow(0.025), 3U);
  EXPECT_EQ(pieces_with_bow(0.003), 2U);
}

TEST_F(ReadFolder, WhatWasCutOutOfAPieceStays) {
  cv::Mat picture(900, 1200, CV_8UC3, cv::Scalar(20, 20, 20));
  cv::circle(picture, {400, 450}, 350, cv::Scalar(240, 240, 240), cv::FILLED, cv::LINE_AA);
  cv::rectangle(picture, cv::Rect(300, 400, 200, 120), cv::Scalar(20, 20, 20), cv::FILLED);
  cv::rectangle(picture, cv::Rect(900, 400, 200, 120), cv::Scalar(240, 240, 240), cv::FILLED);
  cv::imwrite((folder_ / "page.png").string(), picture);
  cv::imwrite((folder_ / "a.png").string(), blot(50));
  cv::imwrite((folder_ / "b.png").string(), blot(60));
  EXPECT_EQ(read_folder(folder_.string()).pieces.size(), 4U);
}

TEST_F(ReadFolder, NamesThatAreNoUtf8AreToldAndLeftOut) {
  write("\xC3\xBC.csv", "0,0\n1,0\n1,1\n0,1\n");
  write("p\xFE.csv", "0,0\n2,0\n2,2\n0,2\n");
  write("p\xFF.csv", "0,0\n3,0\n3,3\n0,3\n");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 1U);
  EXPECT_EQ(set.pieces[0].name, "\xC3\xBC.csv");
  ASSERT_EQ(set.unusable.size(), 2U);
  EXPECT_NE(set.unusable[0].reason.find("p\uFFFD.csv: has a name that is no UTF-8"), std::string::npos);
}

TEST_F(ReadFolder, APieceInAnotherUnitIsDoubted) {
  write("a.csv", "0,0\n4,0\n4,3\n0,2\n");
  write("b.csv", "0,0\n5,0\n5,3\n0,4\n");
  write("c.csv", "0,0\n900,0\n900,300\n0,200\n");
  EXPECT_TRUE(read_folder(folder_.string()).notes.empty());
  write("c.csv", "0,0\n4000,0\n4000,3000\n0,2000\n");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_EQ(set.notes[0].find("c.csv has a border"), 0U) << set.notes[0];
}

TEST_F(ReadFolder, FolderIsReadInTheOrderOfNames) {
  write("b.csv", "0,0\n1,0\n1,1\n0,1\n");
  write("a.csv", "0,0\n2,0\n2,2\n0,2\n");
  write("truth.json", "{}");
  write("notes.md", "nothing");
  const PieceSet set = read_folder(folder_.string());
  ASSERT_EQ(set.pieces.size(), 2U);
  EXPECT_EQ(set.pieces[0].name, "a.csv");
  EXPECT_EQ(set.pieces[1].name, "b.csv");
  EXPECT_THROW(read_folder((folder_ / "missing").string()), IoError);
  std::filesystem::create_directories(folder_ / "empty");
  EXPECT_THROW(read_folder((folder_ / "empty").string()), InputError);
  EXPECT_THROW(read_pieces((folder_ / "notes.md").string()), InputError);
}

}  // namespace
}  // namespace rejoin::outline
