#include "picture/texture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "picture/image_file.hpp"

namespace rejoin::picture {
namespace {

constexpr std::size_t kMostPixels = std::size_t{16384} * 16384;

/// Bytes with three channels, red first.
cv::Mat to_rgb(const cv::Mat& image, const std::string& name) {
  if (image.depth() != CV_8U && image.depth() != CV_16U)
    throw InputError(name, "has floating-point samples", "save it with 8 or 16 bits a channel");
  cv::Mat rgb;
  image.convertTo(rgb, CV_8U, image.depth() == CV_16U ? 255.0 / 65535.0 : 1.0);
  const int channels = rgb.channels();
  cv::cvtColor(rgb, rgb,
               channels == 1 ? cv::COLOR_GRAY2RGB : (channels == 4 ? cv::COLOR_BGRA2RGB : cv::COLOR_BGR2RGB));
  return rgb;
}

/// Pixel of a coordinate of which 1 is the whole side.
std::size_t pixel(double place, std::size_t side) {
  const double wrapped = place - std::floor(place);
  return std::min(static_cast<std::size_t>(wrapped * static_cast<double>(side)), side - 1);
}

}  // namespace

Texture::Texture(const std::string& bytes, const std::string& name) {
  const cv::Mat rgb = to_rgb(decode_image(bytes, name, kMostPixels), name);
  width_ = static_cast<std::size_t>(rgb.cols);
  height_ = static_cast<std::size_t>(rgb.rows);
  pixels_.reserve(width_ * height_);
  for (int row = 0; row < rgb.rows; ++row) {
    for (int column = 0; column < rgb.cols; ++column) {
      const auto& value = rgb.at<cv::Vec3b>(row, column);
      pixels_.emplace_back(value[0], value[1], value[2]);
    }
  }
}

glm::u8vec3 Texture::at(const glm::dvec2& place) const {
  if (!std::isfinite(place.x) || !std::isfinite(place.y)) return glm::u8vec3(255);
  return pixels_[pixel(place.y, height_) * width_ + pixel(place.x, width_)];
}

}  // namespace rejoin::picture
