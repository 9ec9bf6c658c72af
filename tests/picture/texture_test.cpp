// Colours of pictures that lie on surfaces.
#include "picture/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <opencv2/imgcodecs.hpp>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace rejoin::picture {
namespace {

std::string encoded(const cv::Mat& image, const char* kind) {
  std::vector<unsigned char> bytes;
  cv::imencode(kind, image, bytes);
  return {bytes.begin(), bytes.end()};
}

TEST(Texture, BeginsInTheUpperLeftCornerAndRepeatsItself) {
  const cv::Mat image =
      (cv::Mat_<cv::Vec3b>(2, 2) << cv::Vec3b(3, 2, 1), cv::Vec3b(30, 20, 10),  // blue first
       cv::Vec3b(6, 5, 4), cv::Vec3b(60, 50, 40));
  const Texture texture(encoded(image, ".png"), "a.png");
  const glm::u8vec3 upper_left(1, 2, 3);
  const glm::u8vec3 upper_right(10, 20, 30);
  const glm::u8vec3 lower_left(4, 5, 6);
  EXPECT_EQ(texture.at({0, 0}), upper_left);
  EXPECT_EQ(texture.at({0.51, 0.49}), upper_right);
  EXPECT_EQ(texture.at({0.49, 0.51}), lower_left);
  EXPECT_EQ(texture.at({0.99, 0.99}), glm::u8vec3(40, 50, 60));
  EXPECT_EQ(texture.at({-0.1, 0.1}), upper_right);
  EXPECT_EQ(texture.at({7.1, -12.9}), upper_left);
  EXPECT_EQ(texture.at({0.1, -1e-300}), lower_left) << "rounds to the very end";
  EXPECT_EQ(texture.at({std::nan(""), 0}), glm::u8vec3(255));
}

TEST(Texture, KindsOfPicturesGiveTheSameColours) {
  EXPECT_EQ(Texture(encoded(cv::Mat(1, 1, CV_8UC1, cv::Scalar(90)), ".png"), "grey").at({0, 0}),
            glm::u8vec3(90));
  EXPECT_EQ(Texture(encoded(cv::Mat(1, 1, CV_16UC3, cv::Scalar(65535, 0, 257)), ".png"), "deep").at({0, 0}),
            glm::u8vec3(1, 0, 255));
  EXPECT_EQ(Texture(encoded(cv::Mat(1, 1, CV_8UC4, cv::Scalar(3, 2, 1, 0)), ".png"), "clear").at({0, 0}),
            glm::u8vec3(1, 2, 3));
  const glm::u8vec3 lossy =
      Texture(encoded(cv::Mat(8, 8, CV_8UC3, cv::Scalar(30, 60, 200)), ".jpg"), "a.jpg").at({0, 0});
  EXPECT_LE(glm::length(glm::vec3(lossy) - glm::vec3(200, 60, 30)), 6.0F);
}

TEST(Texture, WhatIsNoPictureOrClaimsTooMuchIsRefused) {
  EXPECT_THROW(Texture("", "empty"), InputError);
  EXPECT_THROW(Texture("RIFF....WEBP", "web"), InputError);
  std::string huge = encoded(cv::Mat(4, 4, CV_8UC3, cv::Scalar(0)), ".png");
  huge[16] = huge[20] = 1;  // 16 million wide and high
  EXPECT_THROW(Texture(huge, "huge"), InputError);
}

// The decoder's own words are kept from stderr by taking the stream away for a while.
TEST(Texture, ErrorsOnManyThreadsLeaveStderrAsItWas) {
  cv::Mat image(1024, 1024, CV_8UC3);  // long enough for the others to come in between
  cv::randu(image, 0, 255);
  std::string damaged = encoded(image, ".png");
  damaged.resize(damaged.size() - 100);
  std::streambuf* const before = std::cerr.rdbuf();
  run_side_by_side(40, [&](std::size_t) { EXPECT_THROW(Texture(damaged, "cut"), InputError); });
  EXPECT_EQ(std::cerr.rdbuf(), before);
}

}  // namespace
}  // namespace rejoin::picture
