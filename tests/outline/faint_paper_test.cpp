/// Paper of nearly the background's colour.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "outline/extract.hpp"
#include "read_files.hpp"

namespace rejoin::outline {
namespace {

class FaintPaper : public testing::ReadFiles {
 protected:
  std::string saved(cv::Mat image) {
    cv::GaussianBlur(image, image, cv::Size(), 0.6);
    const std::string path = (folder_ / "page.png").string();
    cv::imwrite(path, image);
    return path;
  }
};

TEST_F(FaintPaper, ItsPrintIsNotTakenForPieces) {
  cv::Mat image(600, 600, CV_8UC3, cv::Scalar(226, 236, 240));
  cv::rectangle(image, cv::Rect(80, 60, 430, 470), cv::Scalar(215, 230, 236), cv::FILLED);
  for (int y = 110; y < 500; y += 35)
    cv::putText(image, "sold to the parish one field", {110, y}, cv::FONT_HERSHEY_SIMPLEX, 0.7,
                cv::Scalar(40, 30, 30), 2, cv::LINE_AA);
  try {
    extract(saved(image));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("look like print"), std::string::npos) << error.what();
  }
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
