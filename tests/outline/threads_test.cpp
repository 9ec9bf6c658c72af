// What runs out of a piece in a picture, and bays whose mouths closed in it; the true borders are known by construction.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "outline/extract.hpp"
#include "outline/polygon.hpp"
#include "soft_disc.hpp"

namespace rejoin::outline {
namespace {

using testing::disc;
using testing::expect_disc;
using testing::Folder;
using testing::with_alpha;

constexpr double kSide = 300.0;

/// How much of each pixel the disc covers, drawn on with full cover afterwards.
cv::Mat soft_disc() {
  return disc({320, 240});
}

/// A square piece, its border half-way between pixels.
cv::Mat square() {
  cv::Mat cover = cv::Mat::zeros(400, 400, CV_32F);
  cover(cv::Rect(50, 50, static_cast<int>(kSide), static_cast<int>(kSide))) = 1.0F;
  return cover;
}

Extraction extracted_from(const cv::Mat& cover, const ExtractOptions& options = {}) {
  const Folder folder;
  cv::imwrite(folder.file("piece.png"), with_alpha(cover));
  return extract(folder.file("piece.png"), options);
}

void curl(cv::Mat& cover) {
  const std::vector<cv::Point> hair{{100, 60}, {140, 80}, {160, 120}, {210, 130}, {230, 180}, {280, 200}};
  cv::polylines(cover, hair, false, cv::Scalar(1.0), 2);
}

TEST(Threads, HairIsTakenOffToTheBorderOfThePiece) {
  cv::Mat cover = soft_disc();
  curl(cover);
  const Extraction found = extracted_from(cover);
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 2.5);  // a stump as deep as the hair is wide may stay
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("1 narrow strip as of a hair"), std::string::npos) << found.notes[0];
}

TEST(Threads, StayWhereTheUserSaysSo) {
  cv::Mat cover = soft_disc();
  curl(cover);
  ExtractOptions options;
  options.keep_threads = true;
  const Extraction found = extracted_from(cover, options);
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_GT(perimeter(found.pieces[0].points), 2.0 * M_PI * testing::kRadius + 300.0)
      << "out along it and back";
  EXPECT_TRUE(found.notes.empty());
}

TEST(Threads, LineBetweenTwoPiecesDoesNotMakeThemOne) {
  cv::Mat cover = soft_disc();
  cv::circle(cover, {240, 160}, 40, cv::Scalar(1.0), cv::FILLED);
  cv::line(cover, {63, 58}, {240, 160}, cv::Scalar(1.0), 2);
  EXPECT_EQ(extracted_from(cover).pieces.size(), 2U);
}

TEST(Threads, SharpTipsStay) {
  // 20 degrees at its tip, in front of the disc.
  cv::Mat cover = soft_disc();
  const std::vector<cv::Point> tip{{95, 22}, {300, 58}, {95, 94}};
  cv::fillConvexPoly(cover, tip, cv::Scalar(1.0));
  const Extraction found = extracted_from(cover);
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_TRUE(found.notes.empty());
  const auto right = std::ranges::max_element(found.pieces[0].points, {}, &glm::dvec2::x);
  EXPECT_GT(right->x, 298.0);
}

TEST(Threads, StripsAlongARaggedBorderStay) {
  // A strip of two pixels, a pixel beside the border and joined to it by one end.
  cv::Mat cover = square();
  cover(cv::Rect(100, 351, 120, 2)) = 1.0F;
  cover(cv::Rect(100, 350, 2, 1)) = 1.0F;
  const Extraction found = extracted_from(cover);
  EXPECT_TRUE(found.notes.empty());
  const auto lowest = std::ranges::max_element(found.pieces[0].points, {}, &glm::dvec2::y);
  EXPECT_GT(lowest->y, 351.5);
}

/// Takes a round bay out of the square whose mouth is closed by so much of the piece.
cv::Mat with_closed_bay(int mouth) {
  cv::Mat cover = square();
  cv::circle(cover, {195, 50 + mouth + 18}, 18, cv::Scalar(0.0), cv::FILLED);
  return cover;
}

TEST(ClosedBay, IsKeptThoughItIsSmallerThanDust) {
  const Extraction found = extracted_from(with_closed_bay(2));
  ASSERT_EQ(found.pieces[0].holes.size(), 1U) << "1.1 % of the piece, 2 % is dust";
  EXPECT_NEAR(signed_area(found.pieces[0].holes[0]), -M_PI * 18.0 * 18.0, 30.0);
}

TEST(ClosedBay, IsNoHoleThatLiesFarInside) {
  EXPECT_TRUE(extracted_from(with_closed_bay(20)).pieces[0].holes.empty());
}

}  // namespace
}  // namespace rejoin::outline
