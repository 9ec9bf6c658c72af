#include "outline/extract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "outline/polygon.hpp"
#include "soft_disc.hpp"

namespace rejoin::outline {
namespace {

using testing::disc;
using testing::expect_disc;
using testing::Folder;
using testing::kCentre;
using testing::painted;
using testing::with_alpha;

TEST(Extract, ContourOfASoftDiscIsExactToATenthOfAPixel) {
  const Folder folder;
  cv::imwrite(folder.file("disc.png"), with_alpha(disc({128, 120})));
  const Extraction found = extract(folder.file("disc.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 0.1);
  EXPECT_FALSE(find_crossing(found.pieces[0].points));
  ASSERT_EQ(found.pieces[0].colour.size(), found.pieces[0].points.size());
  for (const glm::dvec3& c : found.pieces[0].colour)
    EXPECT_LT(glm::distance(c, glm::dvec3(0.8, 0.4, 0.2)), 1e-3);
}

// 8 and 16 bits, PNG and TIFF, light on dark and dark on light: the threshold lies half-way between piece and background.
TEST(Extract, PlainBackgroundNeedsNoAlpha) {
  const Folder folder;
  const cv::Mat cover = disc({128, 120});
  const cv::Vec3d stone(0.5, 0.6, 0.7);
  cv::imwrite(folder.file("dark.png"), painted(cover, stone, {0.05, 0.05, 0.05}, 255, CV_8UC3));
  cv::imwrite(folder.file("white.tif"), painted(cover, stone, {1, 1, 1}, 65535, CV_16UC3));
  cv::imwrite(folder.file("blue.png"), painted(cover, stone, {0.9, 0.2, 0.1}, 65535, CV_16UC3));
  for (const char* name : {"dark.png", "white.tif", "blue.png"}) {
    const Extraction found = extract(folder.file(name));
    ASSERT_EQ(found.pieces.size(), 1U) << name;
    expect_disc(found.pieces[0],
                0.25);  // Otsu's threshold lies between the colours, not just at their middle
  }
}

/// The picture under light that falls off over it, and differently in each colour.
cv::Mat in_uneven_light(cv::Mat image) {
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double fall = 0.5 * x / image.cols + 0.2 * y / image.rows;
      auto& pixel = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<uchar>(pixel[c] * (1.0 - fall * (0.8 + 0.1 * c)));
    }
  }
  return image;
}

// The disc is 30 % darker than the background, which is 60 % darker at one corner than at the other.
TEST(Extract, UnevenLightIsEvenedOutWithANote) {
  const Folder folder;
  cv::imwrite(folder.file("lamp.png"),
              in_uneven_light(painted(disc({150, 130}), {0.65, 0.6, 0.55}, {0.9, 0.9, 0.9}, 255, CV_8UC3)));
  const Extraction found = extract(folder.file("lamp.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 0.3);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("evened out"), std::string::npos) << found.notes[0];
}

// More than half of the frame is as bright as the scanner can tell.
TEST(Extract, UnevenLightThatIsClippedIsEvenedOut) {
  const Folder folder;
  cv::Mat image(600, 800, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double u = x / 400.0 - 1.0;
      const double light = 255.0 * (1.1 - 0.3 * u * u);
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(static_cast<unsigned char>(std::min(255.0, light)));
    }
  }
  cv::circle(image, {400, 300}, 120, cv::Scalar(60, 90, 140), cv::FILLED, cv::LINE_AA);
  cv::imwrite(folder.file("lid.png"), image);
  const Extraction found = extract(folder.file("lid.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_NEAR(signed_area(found.pieces[0].points), M_PI * 120.5 * 120.5, 500.0);
}

TEST(Extract, BackgroundThatChangesItsHueAloneIsNotCalledDarker) {
  const Folder folder;
  cv::Mat image = painted(disc({150, 130}), {0.1, 0.1, 0.1}, {0.6, 0.6, 0.6}, 255, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      auto& pixel = image.at<cv::Vec3b>(y, x);
      const int shift = 60 * x / image.cols - 30;
      pixel = {cv::saturate_cast<uchar>(pixel[0] - shift), pixel[1],
               cv::saturate_cast<uchar>(pixel[2] + shift)};
    }
  }
  cv::imwrite(folder.file("hue.png"), image);
  const Extraction found = extract(folder.file("hue.png"));
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_EQ(found.notes[0], "the background's colour changes over the picture, which is evened out");
}

// Stripes of ink run out of the disc every 12 pixels, nearer to the background than to the paper, or farther.  They may be bitten
// by some pixels, not cut off.
TEST(Extract, PrintAtTheBorderIsPartOfThePiece) {
  struct Page {
    cv::Vec3d background;
    cv::Vec3d ink;
    int stripe;  // pixels
  };
  const Folder folder;
  const cv::Mat cover = disc({128, 120});
  for (const Page& page :
       {Page{{0.12, 0.12, 0.12}, {0.0, 0.0, 0.0}, 4}, Page{{0.8, 0.8, 0.8}, {0.1, 0.1, 0.1}, 2}}) {
    cv::Mat image = painted(cover, {0.95, 0.95, 0.92}, page.background, 255, CV_8UC3);
    const cv::Mat printed = painted(cover, page.ink, page.background, 255, CV_8UC3);
    for (int y = 0; y < image.rows; ++y)
      if (y % 12 < page.stripe && std::abs(y - kCentre.y) < 25.0) printed.row(y).copyTo(image.row(y));
    cv::imwrite(folder.file("page.png"), image);
    const Extraction found = extract(folder.file("page.png"));
    ASSERT_EQ(found.pieces.size(), 1U);
    expect_disc(found.pieces[0], 3.5);
    EXPECT_TRUE(found.notes.empty()) << found.notes[0];
  }
}

// Half of what paper and ink have on the mean lies inside of ink's own border, and outside of the paper's.
TEST(Extract, InkThatCrossesTheBorderOfPaperOnADarkTableLeavesItWhereItIs) {
  const Folder folder;
  const cv::Mat cover = disc({128, 120});
  cv::Mat image = painted(cover, {0.88, 0.92, 0.95}, {0.08, 0.09, 0.1}, 255, CV_8UC3);
  const cv::Mat ink = painted(cover, {0.5, 0.3, 0.25}, {0.08, 0.09, 0.1}, 255, CV_8UC3);
  for (int y = 0; y < image.rows; ++y)
    if (y % 11 < 5) ink.row(y).copyTo(image.row(y));
  cv::GaussianBlur(image, image, cv::Size(), 0.7);
  cv::imwrite(folder.file("letter.png"), image);
  const Extraction found = extract(folder.file("letter.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 1.2);
}

/// A disc on a plain background with a shadow that reaches 14 pixels beyond it on one side.
/// \param noise  deviation of every channel, of 1   \param behind  blue, green and red of the background, 0..1   \param piece  of the disc
/// \param darkest  share of the light that the shadow takes
cv::Mat shadowed_disc(const cv::Vec3d& behind, double noise, const cv::Vec3d& piece = {0.5, 0.4, 0.3},
                      double darkest = 0.3) {
  const cv::Mat cover = disc({150, 130});
  cv::Mat shadow;
  cv::warpAffine(cover, shadow, cv::Matx23d(1, 0, 6, 0, 1, 4), cover.size());
  cv::GaussianBlur(shadow, shadow, cv::Size(), 5.0);
  cv::Mat image = painted(cover, piece, behind, 255, CV_8UC3);
  cv::RNG random(5);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double light = 1.0 - darkest * shadow.at<float>(y, x) * (1.0 - cover.at<float>(y, x));
      auto& pixel = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<uchar>(light * pixel[c] + 255.0 * random.gaussian(noise));
    }
  }
  return image;
}

TEST(Extract, ShadowIsNoPartOfThePiece) {
  const Folder folder;
  cv::imwrite(folder.file("shadow.png"), shadowed_disc({0.9, 0.9, 0.9}, 0.0));
  const Extraction found = extract(folder.file("shadow.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 1.0);
}

// As dark as the shadow that it casts, with no edge between the two: only its size tells it from more shadow.
TEST(Extract, PieceOfTheShadowsColourIsNoShadow) {
  const Folder folder;
  const cv::Vec3d lid(0.9, 0.9, 0.9);
  cv::Mat image = shadowed_disc(lid, 0.01);
  cv::hconcat(image, shadowed_disc(lid, 0.01), image);
  cv::hconcat(image, shadowed_disc(lid, 0.01, {0.6, 0.6, 0.6}), image);
  cv::imwrite(folder.file("three.png"), image);
  const Extraction found = extract(folder.file("three.png"));
  ASSERT_EQ(found.pieces.size(), 3U);
  const double whole = signed_area(found.pieces[0].points);
  for (const Outline& piece : found.pieces) {
    double area = signed_area(piece.points);
    for (const auto& hole : piece.holes) area += signed_area(hole);
    EXPECT_GT(area, 0.85 * whole);
  }
}

TEST(Extract, ShadowOfPaperOnADarkTableIsNoPartOfIt) {
  const Folder folder;
  cv::imwrite(folder.file("shadow.png"), shadowed_disc({0.14, 0.17, 0.2}, 0.0, {0.85, 0.9, 0.92}, 0.7));
  const Extraction found = extract(folder.file("shadow.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 1.0);
}

// What a channel that is weak in the background has left of the light is mostly noise.
TEST(Extract, ShadowOnANoisyBoardOfAStrongColourIsNoPartOfThePiece) {
  const Folder folder;
  cv::imwrite(folder.file("shadow.png"), shadowed_disc({0.75, 0.35, 0.1}, 0.025));
  const Extraction found = extract(folder.file("shadow.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 2.0);
}

TEST(Extract, BedOfAScannerInADarkFrameIsToldAsARectangle) {
  const Folder folder;
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(20, 20, 20));
  cv::rectangle(image, {8, 8}, {291, 191}, cv::Scalar(230, 230, 230), cv::FILLED);
  cv::circle(image, {140, 90}, 50, cv::Scalar(60, 90, 140), cv::FILLED);
  cv::imwrite(folder.file("bed.png"), image);
  const Extraction found = extract(folder.file("bed.png"));
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("scanner's bed"), std::string::npos) << found.notes[0];
}

TEST(Extract, OutlineOfAGlowIsToldAsBlurred) {
  const Folder folder;
  cv::Mat image(200, 200, CV_8UC3, cv::Scalar(60, 60, 60));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double glow = std::max(0.0, 1.0 - glm::distance(glm::dvec2(x, y), glm::dvec2(100, 100)) / 90.0);
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<uchar>(60 + 180 * glow));
    }
  }
  cv::imwrite(folder.file("glow.png"), image);
  const Extraction found = extract(folder.file("glow.png"));
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("blurred"), std::string::npos) << found.notes[0];
}

TEST(Extract, JpegIsReadToAPixel) {
  const Folder folder;
  cv::imwrite(folder.file("disc.jpg"),
              painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0.02, 0.02, 0.02}, 255, CV_8UC3));
  const Extraction found = extract(folder.file("disc.jpg"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 1.0);
}

TEST(Extract, HolesAreKeptAndDustIsNot) {
  const Folder folder;
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::rectangle(image, {20, 20}, {119, 179}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::rectangle(image, {50, 60}, {89, 99}, cv::Scalar(250, 250, 250), cv::FILLED);
  cv::rectangle(image, {180, 40}, {239, 99}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::circle(image, {270, 150}, 3, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("two.png"), image);
  const Extraction found = extract(folder.file("two.png"));
  ASSERT_EQ(found.pieces.size(), 2U);
  EXPECT_NEAR(signed_area(found.pieces[0].points), 100.0 * 160.0, 20.0);
  ASSERT_EQ(found.pieces[0].holes.size(), 1U);
  EXPECT_NEAR(signed_area(found.pieces[0].holes[0]), -40.0 * 40.0, 10.0);
  EXPECT_NEAR(signed_area(found.pieces[1].points), 60.0 * 60.0, 10.0);
  EXPECT_TRUE(found.pieces[1].holes.empty());
}

// Tracings of pieces; what is drawn on one is none.
TEST(Extract, WhatDrawnLinesEncloseIsThePiece) {
  const Folder folder;
  cv::Mat paper(300, 700, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::circle(paper, {150, 150}, 100, cv::Scalar(30, 30, 30), 3, cv::LINE_AA);
  cv::circle(paper, {450, 150}, 120, cv::Scalar(30, 30, 30), 3, cv::LINE_AA);
  cv::line(paper, {420, 130}, {480, 160}, cv::Scalar(30, 30, 30), 6, cv::LINE_AA);
  cv::imwrite(folder.file("tracing.png"), paper);
  const Extraction found = extract(folder.file("tracing.png"), {.dust = 0.1});
  ASSERT_EQ(found.pieces.size(), 2U);
  EXPECT_TRUE(found.pieces[0].holes.empty());
  EXPECT_NEAR(signed_area(found.pieces[0].points) / (M_PI * 121.5 * 121.5), 1.0, 0.03);
  EXPECT_TRUE(std::ranges::any_of(found.notes, [](const std::string& note) {
    return note == "2 pieces are drawn with a line: what it encloses is taken for the piece";
  }));
  cv::circle(paper, {150, 150}, 80, cv::Scalar(30, 30, 30), 40, cv::LINE_AA);
  cv::circle(paper, {450, 150}, 95, cv::Scalar(30, 30, 30), 50, cv::LINE_AA);
  cv::imwrite(folder.file("rings.png"), paper);
  const Extraction rings = extract(folder.file("rings.png"));
  EXPECT_FALSE(rings.pieces.at(0).holes.empty()) << "a ring is one";
}

// As many pieces as fill a scan are each a small part of it, whatever they are: letters and specks have few pixels, too.
TEST(Extract, ManySmallPiecesAreDoubtedAndManyLargeOnesAreNot) {
  const Folder folder;
  for (const int side : {60, 270}) {
    cv::Mat image(12 * side, 12 * side, CV_8UC3, cv::Scalar(250, 250, 250));
    for (int k = 0; k < 25; ++k) {
      const cv::Point corner(2 * side * (k % 5) + side, 2 * side * (k / 5) + side);
      cv::rectangle(image, corner, corner + cv::Point(side, side), cv::Scalar(40, 60, 90), cv::FILLED);
    }
    cv::imwrite(folder.file("many.png"), image);
    const Extraction found = extract(folder.file("many.png"));
    EXPECT_EQ(found.pieces.size(), 25U);
    const bool doubted = std::ranges::any_of(found.notes, [](const std::string& note) {
      return note.find("letters or specks") != std::string::npos;
    });
    EXPECT_EQ(doubted, side == 60) << side;
  }
}

TEST(Extract, SmallPieceIsToldAndTakenIfAskedFor) {
  const Folder folder;
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::rectangle(image, {20, 20}, {219, 179}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::rectangle(image, {250, 40}, {273, 63}, cv::Scalar(40, 60, 90),
                cv::FILLED);  // 1.8 % of the other's area
  cv::circle(image, {270, 150}, 3, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("two.png"), image);
  const Extraction usual = extract(folder.file("two.png"));
  EXPECT_EQ(usual.pieces.size(), 1U);
  ASSERT_EQ(usual.notes.size(), 1U);
  EXPECT_NE(
      usual.notes[0].find("1 piece with less than 2 % of the largest's area is taken for dust, the largest "
                          "24 x 24 pixels at x 250, y 40"),
      std::string::npos)
      << usual.notes[0];
  ExtractOptions options;
  options.dust = 1.0;
  const Extraction asked = extract(folder.file("two.png"), options);
  ASSERT_EQ(asked.pieces.size(), 2U);
  EXPECT_NEAR(signed_area(asked.pieces[1].points), 24.0 * 24.0, 5.0);
  EXPECT_TRUE(asked.notes.empty());
}

TEST(Extract, PieceAtTheBorderIsTakenWithANoteOrLeftOut) {
  const Folder folder;
  cv::Mat image(100, 200, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::rectangle(image, {0, 20}, {59, 79}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("one.png"), image);
  const Extraction one = extract(folder.file("one.png"));
  ASSERT_EQ(one.pieces.size(), 1U);
  EXPECT_EQ(one.notes.size(), 1U);
  EXPECT_NEAR(signed_area(one.pieces[0].points), 60.0 * 60.0, 5.0);
  cv::rectangle(image, {120, 30}, {159, 69}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("both.png"), image);
  const Extraction both = extract(folder.file("both.png"));
  ASSERT_EQ(both.pieces.size(), 1U);
  EXPECT_EQ(both.notes.size(), 1U);
  EXPECT_NEAR(signed_area(both.pieces[0].points), 40.0 * 40.0, 5.0);
}

}  // namespace
}  // namespace rejoin::outline
