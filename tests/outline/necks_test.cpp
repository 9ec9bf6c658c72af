// Pieces that touch in a picture, drawn so that the places where they do are known.
#include "outline/detail/necks.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "outline/extract.hpp"
#include "soft_disc.hpp"

namespace rejoin::outline {
namespace {

using testing::Folder;

cv::Mat empty(int width, int height) {
  return cv::Mat::zeros(height, width, CV_8U);
}

void draw_disc(cv::Mat& mask, const glm::dvec2& centre, double radius) {
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (glm::distance(glm::dvec2(x, y), centre) <= radius) mask.at<uchar>(y, x) = 255;
}

/// Two discs of radius 60 whose circles' crossings are as far apart as this.
cv::Mat two_discs(double neck) {
  constexpr double kDisc = 60.0;
  const double half = std::sqrt(kDisc * kDisc - 0.25 * neck * neck);
  cv::Mat mask = empty(340, 200);
  draw_disc(mask, {170.0 - half, 100.0}, kDisc);
  draw_disc(mask, {170.0 + half, 100.0}, kDisc);
  return mask;
}

/// Two blocks with a slit between them that is bridged at these rows.
cv::Mat bridged(const std::vector<int>& rows) {
  cv::Mat mask = empty(300, 240);
  cv::rectangle(mask, {20, 20, 128, 200}, 255, cv::FILLED);
  cv::rectangle(mask, {152, 20, 128, 200}, 255, cv::FILLED);
  for (const int row : rows) cv::rectangle(mask, {140, row, 20, 6}, 255, cv::FILLED);
  return mask;
}

Extraction extracted(const cv::Mat& mask, const ExtractOptions& options = {}) {
  const Folder folder;
  cv::Mat image;
  cv::merge(std::vector<cv::Mat>{mask, mask, mask, mask}, image);
  cv::imwrite(folder.file("pieces.png"), image);
  return extract(folder.file("pieces.png"), options);
}

TEST(Necks, AreFoundWhereTwoDiscsCross) {
  const std::vector<detail::Neck> found = detail::necks(two_discs(14.0), 1000.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].place.x, 170, 3);
  EXPECT_NEAR(found[0].place.y, 100, 3);
  EXPECT_NEAR(found[0].width, 14.0, 3.0);
}

TEST(Necks, AreNarrowBesideTheirParts) {
  const std::vector<detail::Neck> found = detail::necks(two_discs(40.0), 1000.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].wider, 3.0, 0.2);
  EXPECT_TRUE(detail::necks(two_discs(54.0), 1000.0).empty());
}

TEST(Necks, LieBetweenPartsThatAreLargeEnough) {
  cv::Mat mask = empty(300, 200);
  draw_disc(mask, {100.0, 100.0}, 80.0);
  draw_disc(mask, {191.8, 100.0}, 12.0);
  EXPECT_TRUE(detail::necks(mask, 600.0).empty()) << "a disc of 452 pixels";
  EXPECT_EQ(detail::necks(mask, 300.0).size(), 1U);
}

TEST(Necks, ArePartedByTheirCuts) {
  // At 2.4 million pixels several are one cell.
  for (const double scale : {1.0, 6.0}) {
    for (const cv::Mat& drawn : {two_discs(14.0), bridged({60, 160})}) {
      cv::Mat mask;
      cv::resize(drawn, mask, {}, scale, scale, cv::INTER_NEAREST);
      for (const detail::Neck& neck : detail::necks(mask, 1000.0 * scale * scale))
        for (const cv::Rect& cell : neck.cut) mask(cell & cv::Rect({0, 0}, mask.size())) = 0;
      cv::Mat labels;
      EXPECT_EQ(cv::connectedComponents(mask, labels, 8), 3) << "the outside and two parts";
      EXPECT_GT(cv::countNonZero(mask), 0.99 * scale * scale * cv::countNonZero(drawn));
    }
  }
}

TEST(Extract, TellsWherePiecesTouch) {
  const Extraction found = extracted(two_discs(14.0));
  EXPECT_EQ(found.pieces.size(), 1U);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("1 place where pieces seem to touch"), std::string::npos) << found.notes[0];
  EXPECT_TRUE(extracted(two_discs(40.0)).notes.empty());
  EXPECT_TRUE(extracted(bridged({})).notes.empty());
}

TEST(Extract, PartsPiecesThatTouchIfAsked) {
  ExtractOptions options;
  options.part_touching = true;
  const Extraction discs = extracted(two_discs(14.0), options);
  ASSERT_EQ(discs.pieces.size(), 2U);
  for (const Outline& piece : discs.pieces) EXPECT_NEAR(signed_area(piece.points), M_PI * 3600.0, 150.0);
  const Extraction blocks = extracted(bridged({60, 160}), options);
  ASSERT_EQ(blocks.pieces.size(), 2U);
  for (const Outline& piece : blocks.pieces) {
    EXPECT_NEAR(signed_area(piece.points), 128.0 * 200.0, 150.0);
    EXPECT_TRUE(piece.holes.empty());
  }
}

}  // namespace
}  // namespace rejoin::outline
