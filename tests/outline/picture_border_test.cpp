/// Pieces close to a picture's border, and beyond it.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace rejoin::outline
