// The white core along the tears of printed paper, in pictures whose borders are circles by construction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "outline/extract.hpp"
#include "soft_disc.hpp"

namespace rejoin::outline {
namespace {

using testing::Folder;

constexpr double kFace = 120.0;
const glm::dvec2 kMiddle(200.3, 199.6);
const cv::Vec3d kWhite(0.97, 0.96, 0.95);

/// By the place on the paper, from its middle.
using Colour = std::function<cv::Vec3d(const glm::dvec2&)>;
using Width = std::function<double(double)>;

/// A printed disc, and beyond its face a rim as wide as this in every direction; transparent outside.
cv::Mat paper(const Colour& face, const Width& rim) {
  cv::Mat image(400, 400, CV_8UC4);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const glm::dvec2 p = glm::dvec2(x, y) - kMiddle;
      const double r = glm::length(p);
      const double printed = std::clamp(kFace - r + 0.5, 0.0, 1.0);
      const double covered = std::clamp(kFace + rim(std::atan2(p.y, p.x)) - r + 0.5, 0.0, 1.0);
      const cv::Vec3d colour = printed * face(p) + (1.0 - printed) * kWhite;
      for (int c = 0; c < 3; ++c) image.at<cv::Vec4b>(y, x)[c] = cv::saturate_cast<uchar>(255.0 * colour[c]);
      image.at<cv::Vec4b>(y, x)[3] = cv::saturate_cast<uchar>(255.0 * covered);
    }
  }
  return image;
}

/// Up to this many pixels, along half of the border.
Width torn(double most) {
  return [most](double angle) { return std::max(0.0, most * std::cos(angle)); };
}

cv::Vec3d photograph(const glm::dvec2& p) {
  return {0.4 + 0.3 * std::sin(0.05 * p.x), 0.4 + 0.3 * std::cos(0.04 * p.y),
          0.3 + 0.2 * std::sin(0.03 * (p.x + p.y))};
}

Extraction extracted(const cv::Mat& image, const ExtractOptions& options = {}) {
  const Folder folder;
  cv::imwrite(folder.file("paper.png"), image);
  return extract(folder.file("paper.png"), options);
}

/// The largest distance of the border from a circle's, pixels.
double off_circle(const Outline& outline, double radius) {
  double most = 0.0;
  for (const glm::dvec2& p : outline.points)
    most = std::max(most, std::abs(glm::distance(p, kMiddle) - radius));
  return most;
}

TEST(TornCore, IsTakenOffToTheBorderOfTheFace) {
  const Extraction found = extracted(paper(photograph, torn(8.0)));
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_LT(off_circle(found.pieces[0], kFace), 0.8) << "less than two pixels of it may stay";
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("the core of printed paper"), std::string::npos) << found.notes[0];
}

TEST(TornCore, IsTakenOffOfItsOwnPieceAlone) {
  // A square beside the torn side, in the box around the print.
  cv::Mat image = paper(photograph, torn(8.0));
  cv::rectangle(image, cv::Rect(292, 72, 36, 36), cv::Scalar(60, 90, 140, 255), cv::FILLED);
  const Extraction found = extracted(image);
  ASSERT_EQ(found.pieces.size(), 2U);
  EXPECT_NEAR(signed_area(found.pieces[1].points), 36.0 * 36.0, 40.0);
}

TEST(TornCore, StaysWhereTheUserSaysSo) {
  ExtractOptions options;
  options.keep_core = true;
  const Extraction found = extracted(paper(photograph, torn(8.0)), options);
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_GT(off_circle(found.pieces[0], kFace), 7.5);
  EXPECT_TRUE(found.notes.empty());
}

TEST(TornCore, IsNoneWhereTheFaceIsAsWhite) {
  // Lines of writing every 12 pixels.
  const Colour written = [](const glm::dvec2& p) {
    const bool ink = std::abs(std::remainder(p.y, 12.0)) < 2.0 && std::abs(std::remainder(p.x, 25.0)) < 9.0;
    return ink ? cv::Vec3d(0.2, 0.1, 0.1) : kWhite;
  };
  const Extraction found = extracted(paper(written, [](double) { return 0.0; }));
  ASSERT_EQ(found.pieces.size(), 1U);
  EXPECT_LT(off_circle(found.pieces[0], kFace), 0.5);
  EXPECT_TRUE(found.notes.empty());
}

TEST(TornCore, IsNoEvenWhiteMargin) {
  for (const double width : {8.0, 15.0, 30.0}) {
    const Extraction found = extracted(paper(photograph, [&](double) { return width; }));
    ASSERT_EQ(found.pieces.size(), 1U);
    EXPECT_LT(off_circle(found.pieces[0], kFace + width), 0.5) << width;
    EXPECT_TRUE(found.notes.empty()) << width;
  }
}

/// The paper before a plain background.
cv::Mat opaque(const cv::Mat& image, const cv::Vec3d& background) {
  cv::Mat result(image.size(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto& pixel = image.at<cv::Vec4b>(y, x);
      const double covered = pixel[3] / 255.0;
      for (int c = 0; c < 3; ++c)
        result.at<cv::Vec3b>(y, x)[c] =
            cv::saturate_cast<uchar>(covered * pixel[c] + (1.0 - covered) * 255.0 * background[c]);
    }
  }
  return result;
}

TEST(TornCore, IsTakenOffBeforeABackgroundFromThePrintsAlone) {
  const cv::Vec3d green(0.1, 0.95, 0.1);
  const cv::Mat print = opaque(paper(photograph, torn(8.0)), green);
  const cv::Mat sheet = opaque(paper([](const glm::dvec2&) { return kWhite; }, torn(0.0)), green);
  cv::Mat both;
  cv::hconcat(print, sheet, both);
  const Extraction found = extracted(both);
  ASSERT_EQ(found.pieces.size(), 2U);
  const bool print_first = found.pieces[0].points[0].x < 400.0;
  EXPECT_LT(off_circle(found.pieces[print_first ? 0 : 1], kFace), 1.5) << "colours mix at the border";
  Outline white = found.pieces[print_first ? 1 : 0];
  for (glm::dvec2& p : white.points) p.x -= 400.0;
  EXPECT_LT(off_circle(white, kFace), 0.5);
  ASSERT_EQ(found.notes.size(), 1U) << found.notes.back();
}

// A white plate with a coloured band: what lies at the border of a piece may be white though its middle is not.
TEST(TornCore, IsNoneWhereTheOtherPiecesFacesAreWhite) {
  const Colour banded = [](const glm::dvec2& p) { return p.x < 60.0 ? kWhite : photograph(p); };
  const cv::Mat shows = paper(photograph, torn(8.0));
  cv::Mat both;
  cv::hconcat(shows, paper(banded, [](double) { return 0.0; }), both);
  const Extraction found = extracted(both);
  ASSERT_EQ(found.pieces.size(), 2U);
  const Outline& left = found.pieces[found.pieces[0].points[0].x < 400.0 ? 0 : 1];
  EXPECT_GT(off_circle(left, kFace), 7.5) << "nothing is taken off";
  EXPECT_TRUE(found.notes.empty());
}

TEST(TornCore, IsNoneOfOnePieceAmongMany) {
  cv::Mat row = paper(photograph, torn(8.0));
  const cv::Mat plain = paper(photograph, [](double) { return 0.0; });
  for (int k = 0; k < 4; ++k) cv::hconcat(row, plain, row);
  const Extraction found = extracted(row);
  ASSERT_EQ(found.pieces.size(), 5U);
  const auto first =
      std::ranges::find_if(found.pieces, [](const Outline& o) { return o.points[0].x < 400.0; });
  EXPECT_GT(off_circle(*first, kFace), 7.5);
  EXPECT_TRUE(found.notes.empty());
}

}  // namespace
}  // namespace rejoin::outline
