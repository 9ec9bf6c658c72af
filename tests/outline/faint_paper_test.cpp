/// Paper of nearly the background's colour.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "outline/extract.hpp"
#include "outline/polygon.hpp"
#include "read_files.hpp"

namespace rejoin::outline {
namespace {

class FaintPaper : public testing::ReadFiles {
 protected:
  std::string saved(cv::Mat image) {
    cv::GaussianBlur(image, image, cv::Size(), 0.6);
    std::string path = (folder_ / "page.png").string();
    cv::imwrite(path, image);
    return path;
  }
};

/// A printed page of 430 x 470 pixels.
cv::Mat page(const cv::Scalar& background, const cv::Scalar& paper) {
  cv::Mat image(600, 600, CV_8UC3, background);
  cv::rectangle(image, cv::Rect(80, 60, 430, 470), paper, cv::FILLED);
  for (int y = 110; y < 500; y += 35)
    cv::putText(image, "sold to the parish one field", {110, y}, cv::FONT_HERSHEY_SIMPLEX, 0.7,
                cv::Scalar(40, 30, 30), 2, cv::LINE_AA);
  return image;
}

// Both are of one hue, 10 of 255 apart.
TEST_F(FaintPaper, ItsPrintIsNotTakenForPieces) {
  try {
    extract(saved(page({226, 236, 240}, {217, 226, 230})));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("look like print"), std::string::npos) << error.what();
  }
}

TEST_F(FaintPaper, OfAnotherHueIsThePiece) {
  const Extraction found = extract(saved(page({251, 251, 251}, {228, 240, 244})));
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_TRUE(found.notes.empty()) << found.notes[0];
  EXPECT_NEAR(signed_area(found.pieces[0].points), 430.0 * 470.0, 0.002 * 430.0 * 470.0);
}

// A shadow, 45 % at its darkest, falls on the scanner's lid below and to the right.
// A surface between paper and background would follow both.
TEST_F(FaintPaper, OnABackgroundOfOneColourIsNoUnevenLight) {
  cv::Mat image(1000, 900, CV_16SC3, cv::Scalar(245, 244, 243));
  cv::Mat paper = cv::Mat::zeros(image.size(), CV_8U);
  cv::ellipse(paper, {450, 500}, {410, 470}, 0, 0, 360, cv::Scalar(255), cv::FILLED);
  image.setTo(cv::Scalar(230, 238, 240), paper);
  for (int y = 220; y < 820; y += 50) {
    cv::putText(image, "sold to the parish one field", {200, y}, cv::FONT_HERSHEY_SIMPLEX, 1.0,
                cv::Scalar(60, 70, 80), 3);
  }
  cv::Mat noise(image.size(), CV_16SC3);
  cv::theRNG().state = 7;
  cv::randn(noise, cv::Scalar::all(0), cv::Scalar::all(1));
  cv::Mat grain(image.size(), CV_16SC3);
  cv::randn(grain, cv::Scalar::all(0), cv::Scalar::all(5));
  grain.copyTo(noise, paper);
  image += noise;
  image.convertTo(image, CV_8U);
  const Extraction found = extract(saved(image));
  const double area = M_PI * 410.0 * 470.0;
  EXPECT_NEAR(signed_area(found.pieces[0].points), area, 0.02 * area);
  for (const std::string& note : found.notes) EXPECT_EQ(note.find("evened out"), std::string::npos) << note;
}

TEST_F(FaintPaper, OfAnotherHueIsToldFromItsShadow) {
  const cv::Rect paper(80, 60, 430, 470);
  cv::Mat light(600, 600, CV_32F, cv::Scalar(1.0));
  light(paper + cv::Point(6, 6)).setTo(0.55);
  cv::GaussianBlur(light, light, cv::Size(), 6.0);
  light(paper).setTo(1.0);
  cv::Mat image = page({251, 251, 251}, {228, 240, 244});
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) image.at<cv::Vec3b>(y, x) *= light.at<float>(y, x);
  const Extraction found = extract(saved(image));
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_TRUE(found.notes.empty()) << found.notes[0];
  const glm::dvec2 middle(294.5, 294.5);
  for (const glm::dvec2& p : found.pieces[0].points) {
    const glm::dvec2 off = glm::abs(p - middle) - glm::dvec2(215.0, 235.0);
    EXPECT_NEAR(std::max(off.x, off.y), 0.0, 1.5) << p.x << ", " << p.y;
  }
}

// White paper torn across its print on a grey lid: around letters the light passes the lid's own, and the border ran around each of them.
TEST_F(FaintPaper, LetteringThatTheBorderCutsIsPartOfThePiece) {
  const cv::Rect paper(80, 60, 430, 470);
  cv::Mat image(600, 600, CV_8UC3, cv::Scalar(232, 232, 232));
  image(paper).setTo(cv::Scalar(248, 250, 250));
  cv::Mat inside = image(paper);
  for (int y = 30; y < 460; y += 30)
    cv::putText(inside, "and in witness thereof we sign", {-7, y}, cv::FONT_HERSHEY_SIMPLEX, 0.9,
                cv::Scalar(40, 30, 30), 2, cv::LINE_AA);
  const Extraction found = extract(saved(image));
  ASSERT_EQ(found.pieces.size(), 1U);
  const glm::dvec2 middle(294.5, 294.5);
  std::size_t off_the_side = 0;
  for (const glm::dvec2& p : found.pieces[0].points) {
    const glm::dvec2 off = glm::abs(p - middle) - glm::dvec2(215.0, 235.0);
    if (std::abs(std::max(off.x, off.y)) > 1.5) ++off_the_side;
  }
  EXPECT_LT(off_the_side,
            found.pieces[0].points.size() / 4);  // without: four fifths, in rings around letters
}

// Dark pieces have no print: nothing between them, or in them, is a seam.
TEST_F(FaintPaper, GapsOfEightPixelsBetweenDarkPiecesStayOpen) {
  cv::Mat image(300, 400, CV_8UC3, cv::Scalar(250, 250, 250));
  const cv::Scalar brown(60, 90, 130);
  cv::rectangle(image, cv::Rect(40, 60, 120, 160), brown, cv::FILLED);
  cv::rectangle(image, cv::Rect(168, 60, 150, 160), brown, cv::FILLED);
  cv::rectangle(image, cv::Rect(240, 60, 8, 60), cv::Scalar(250, 250, 250), cv::FILLED);  // a notch
  const Extraction found = extract(saved(image));
  ASSERT_EQ(found.pieces.size(), 2U);
  const double both = signed_area(found.pieces[0].points) + signed_area(found.pieces[1].points);
  EXPECT_NEAR(both, 120.0 * 160.0 + 150.0 * 160.0 - 8.0 * 60.0, 150.0);
}

TEST_F(FaintPaper, ManySmallPiecesWithSoftShadowsAreNoPrint) {
  cv::Mat shade(900, 900, CV_32F, cv::Scalar(0.0));
  cv::Mat cover(900, 900, CV_8U, cv::Scalar(0));
  for (int k = 0; k < 36; ++k) {
    const cv::Point at(80 + 145 * (k % 6), 80 + 145 * (k / 6));
    cv::circle(cover, at, 35, cv::Scalar(255), cv::FILLED);
    cv::circle(shade, at + cv::Point(6, 6), 35, cv::Scalar(0.2), cv::FILLED);
  }
  cv::GaussianBlur(shade, shade, cv::Size(), 6.0);
  cv::Mat light = 235.0 * (1.0 - shade);
  cv::Mat grey;
  light.convertTo(grey, CV_8U);
  cv::Mat image;
  cv::cvtColor(grey, image, cv::COLOR_GRAY2BGR);
  image.setTo(cv::Scalar(60, 90, 140), cover);
  EXPECT_EQ(extract(saved(image)).pieces.size(), 36U);
}

}  // namespace
}  // namespace rejoin::outline
