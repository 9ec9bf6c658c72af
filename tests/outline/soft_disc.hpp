/// A disc with soft edges as pictures show it, and a folder for their files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "outline/polygon.hpp"

namespace rejoin::outline::testing {

/// A folder for one test, taken away after it.
class Folder {
 public:
  Folder() {
    path_ =
        std::filesystem::temp_directory_path() /
        ("rejoin-extract-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
         "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline constexpr double kRadius = 40.0;
inline const glm::dvec2 kCentre(63.3, 58.7);

/// A disc with soft edges: how much of each pixel it covers, about.
inline cv::Mat disc(const cv::Size& size) {
  cv::Mat cover(size, CV_32F);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double distance = kRadius - glm::distance(glm::dvec2(x, y), kCentre);
      cover.at<float>(y, x) = static_cast<float>(std::clamp(distance + 0.5, 0.0, 1.0));
    }
  }
  return cover;
}

/// The disc in colour on a plain background.
inline cv::Mat painted(const cv::Mat& cover, const cv::Vec3d& piece, const cv::Vec3d& background,
                       double scale, int type) {
  cv::Mat image(cover.size(), type);
  for (int y = 0; y < cover.rows; ++y) {
    for (int x = 0; x < cover.cols; ++x) {
      const double share = cover.at<float>(y, x);
      const cv::Vec3d colour = (piece * share + background * (1.0 - share)) * scale;
      if (type == CV_8UC3) image.at<cv::Vec3b>(y, x) = cv::Vec3b(colour);
      if (type == CV_16UC3) image.at<cv::Vec3w>(y, x) = cv::Vec3w(colour);
    }
  }
  return image;
}

inline cv::Mat with_alpha(const cv::Mat& cover) {
  cv::Mat alpha;
  cover.convertTo(alpha, CV_8U, 255.0);
  const std::vector<cv::Mat> channels{cv::Mat(cover.size(), CV_8U, cv::Scalar(51)),
                                      cv::Mat(cover.size(), CV_8U, cv::Scalar(102)),
                                      cv::Mat(cover.size(), CV_8U, cv::Scalar(204)), alpha};
  cv::Mat image;
  cv::merge(channels, image);
  return image;
}

inline void expect_disc(const Outline& outline, double tolerance) {
  for (const glm::dvec2& p : outline.points) EXPECT_NEAR(glm::distance(p, kCentre), kRadius, tolerance);
  EXPECT_NEAR(signed_area(outline.points), M_PI * kRadius * kRadius, 2.0 * M_PI * kRadius * tolerance);
}

}  // namespace rejoin::outline::testing
