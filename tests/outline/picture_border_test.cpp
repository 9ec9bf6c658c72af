/// Pieces close to a picture's border, and beyond it.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "outline/extract.hpp"
#include "read_files.hpp"

namespace rejoin::outline {
namespace {

class PictureBorder : public testing::ReadFiles {
 protected:
  /// Two light pieces on a dark background, one with its corner at `at`.
  Extraction pieces_at(const cv::Point& at) {
    cv::Mat image(200, 300, CV_8UC3, cv::Scalar(24, 22, 20));
    cv::rectangle(image, cv::Rect(160, 40, 100, 90), cv::Scalar(225, 235, 240), cv::FILLED);
    cv::rectangle(image, cv::Rect(at, cv::Size(80, 100)) & cv::Rect(0, 0, 300, 200),
                  cv::Scalar(225, 235, 240), cv::FILLED);
    cv::GaussianBlur(image, image, cv::Size(), 0.6, 0.6, cv::BORDER_REPLICATE);
    const std::string path = (folder_ / "scan.png").string();
    cv::imwrite(path, image);
    return extract(path);
  }
};

TEST_F(PictureBorder, APieceOnePixelOffItIsWhole) {
  for (const cv::Point at : {cv::Point(1, 60), cv::Point(2, 60), cv::Point(20, 1), cv::Point(20, 98)}) {
    const Extraction found = pieces_at(at);
    EXPECT_TRUE(found.notes.empty()) << found.notes[0];
    ASSERT_EQ(found.pieces.size(), 2U) << at;
    // The blur rounds its corners off.
    EXPECT_NEAR(signed_area(found.pieces[1].points), 80.0 * 100.0, 10.0) << at;
  }
}

TEST_F(PictureBorder, APieceThatGoesOnBeyondItIsNamedByItsPlace) {
  const Extraction found = pieces_at({-9, 60});
  EXPECT_EQ(found.pieces.size(), 1U);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_EQ(found.notes[0],
            "1 of 2 pieces touches the picture's border and is left out (71 x 100 pixels at x 0, y 60)");
}

// As of a glass plate, or a cut of the picture that kept some of what lay beside it.
TEST_F(PictureBorder, LinesAlongTwoOfItsEdgesAreLeftOut) {
  const cv::Mat plain(1000, 1200, CV_8UC3, cv::Scalar(130, 128, 126));
  cv::Mat with_piece = plain.clone();
  cv::circle(with_piece, {600, 500}, 200, cv::Scalar(120, 180, 215), cv::FILLED, cv::LINE_AA);
  const std::string path = (folder_ / "scan.png").string();
  for (const int wide : {1, 4, 25}) {
    cv::Mat image = with_piece.clone();
    image.colRange(0, wide).setTo(cv::Scalar(15, 15, 15));
    image.rowRange(1000 - wide, 1000).setTo(cv::Scalar(15, 15, 15));
    cv::imwrite(path, image);
    const Extraction found = extract(path);
    ASSERT_EQ(found.pieces.size(), 1U) << wide;
    EXPECT_NEAR(signed_area(found.pieces[0].points), M_PI * 200.5 * 200.5, 200.0) << wide;
    ASSERT_EQ(found.notes.size(), 1U) << wide;
    EXPECT_NE(found.notes[0].find(fmt::format("lower ({0} pixels), left ({0} pixels)", wide + 2)),
              std::string::npos)
        << found.notes[0];
  }
}

// The background beside pieces that nearly fill the picture is no line along its edges.
TEST_F(PictureBorder, NarrowMarginsAroundLargePiecesStay) {
  const std::string path = (folder_ / "scan.png").string();
  for (const int margin : {10, 30, 45}) {
    cv::Mat image(1000, 1400, CV_8UC3, cv::Scalar(30, 30, 30));
    cv::rectangle(image, cv::Rect(margin, margin, 660 - margin, 1000 - 2 * margin), cv::Scalar(235, 235, 235),
                  cv::FILLED);
    cv::rectangle(image, cv::Rect(740, margin, 660 - margin, 1000 - 2 * margin), cv::Scalar(235, 235, 235),
                  cv::FILLED);
    for (const int wide : {0, 80}) {  // and with more room on the right
      cv::Mat wider;
      cv::copyMakeBorder(image, wider, 0, 0, 0, wide, cv::BORDER_CONSTANT, cv::Scalar(30, 30, 30));
      cv::imwrite(path, wider);
      const Extraction found = extract(path);
      ASSERT_EQ(found.pieces.size(), 2U) << margin << " " << wide;
      const double area = (660.0 - margin) * (1000.0 - 2.0 * margin);
      EXPECT_NEAR(signed_area(found.pieces[0].points), area, 10.0) << margin << " " << wide;
    }
  }
}

TEST_F(PictureBorder, LightThatFallsOffAndPiecesAtTheBorderAreNoLinesAlongIt) {
  cv::Mat image(1000, 1200, CV_32FC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const float light = 1.0F - 0.3F * static_cast<float>(std::hypot(x - 600, y - 500) / 780.0);
      image.at<cv::Vec3f>(y, x) = light * cv::Vec3f(180, 180, 180);
    }
  }
  cv::rectangle(image, cv::Rect(0, 100, 300, 800), cv::Scalar(40, 60, 80), cv::FILLED);
  cv::circle(image, {800, 500}, 150, cv::Scalar(40, 60, 80), cv::FILLED);
  const std::string path = (folder_ / "scan.png").string();
  cv::imwrite(path, image);
  for (const std::string& note : extract(path).notes)
    EXPECT_EQ(note.find("lines of another colour"), std::string::npos) << note;
}

}  // namespace
}  // namespace rejoin::outline
