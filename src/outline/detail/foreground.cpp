#include "outline/detail/foreground.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/median.hpp"
#include "core/parallel.hpp"

namespace rejoin::outline::detail {
namespace {

/// Light weaker than this share of the brightest is not made up for further.
constexpr float kLeastLight = 0.1F;
/// Pixels are looked at with their neighbours, which takes noise away (standard deviation, pixels).
constexpr double kBlur = 1.0;

// What is farther from the background than all of these is no background: a colour that nobody sees, what the frame varies by, and
// what a JPEG leaves beside an edge.
constexpr double kLeastDistance = 0.04;
constexpr double kNoiseFactor = 4.0;
constexpr double kRinging = 0.06;

/// A darker background has no shadows that matter, 0..1.
constexpr float kShadowsFall = 0.25F;
/// A shadow leaves at least this share of the light,
constexpr float kDarkestShadow = 0.35F;
/// in equal parts of each channel to within this,
constexpr float kSameHue = 0.12F;
/// and changes by less than this from pixel to pixel.
constexpr float kSoft = 0.05F;
/// A pixel of the frame is background if it is this much nearer to it than one of the next few inwards; print narrower than kStroke
/// pixels is none.
constexpr float kOutside = 0.4F;
constexpr int kInwards = 4;
constexpr int kStroke = 9;

/// If taking shadows off leaves less than this share of the foreground, they were none.
constexpr double kLeastLeft = 0.5;

void for_rows(const cv::Mat& image, const std::function<void(int)>& row) {
  parallel_for(static_cast<std::size_t>(image.rows), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y) row(static_cast<int>(y));
  });
}

bool is_shade(const cv::Vec3f& pixel, const cv::Vec3f& behind) {
  float low = 1.0F;
  float high = 0.0F;
  for (int c = 0; c < 3; ++c) {
    if (behind[c] <= 0.0F) return false;
    const float light = pixel[c] / behind[c];
    low = std::min(low, light);
    high = std::max(high, light);
  }
  return low > kDarkestShadow && high < 1.0F && high - low < kSameHue;
}

/// Darker places of the background's own hue where nothing ends.
cv::Mat shades(const Background& background, const cv::Mat& image, const cv::Mat& distance) {
  cv::Mat result = cv::Mat::zeros(image.size(), CV_8U);
  const cv::Vec3f& brightest = background.brightest();
  if (brightest[0] + brightest[1] + brightest[2] < 3.0F * kShadowsFall) return result;
  for_rows(image, [&](int y) {
    if (y == 0 || y + 1 == image.rows) return;
    for (int x = 1; x + 1 < image.cols; ++x) {
      const float across = 0.5F * (distance.at<float>(y, x + 1) - distance.at<float>(y, x - 1));
      const float down = 0.5F * (distance.at<float>(y + 1, x) - distance.at<float>(y - 1, x));
      if (across * across + down * down < kSoft * kSoft &&
          is_shade(image.at<cv::Vec3f>(y, x), background.colour(x, y)))
        result.at<uchar>(y, x) = 255;
    }
  });
  const cv::Mat block = cv::getStructuringElement(cv::MORPH_RECT, {5, 5});
  cv::morphologyEx(result, result, cv::MORPH_OPEN,
                   block);  // no leaks through a pixel or two of a piece's border
  return result;
}

/// The regions of `soft` that touch `bare`.
cv::Mat touching(const cv::Mat& soft, const cv::Mat& bare) {
  cv::Mat labels;
  const int count = cv::connectedComponents(soft, labels, 4, CV_32S);
  cv::Mat wide;
  cv::dilate(bare, wide, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  std::vector<char> touches(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < soft.rows; ++y)
    for (int x = 0; x < soft.cols; ++x)
      if (wide.at<uchar>(y, x) != 0) touches[static_cast<std::size_t>(labels.at<int>(y, x))] = 1;
  cv::Mat result = cv::Mat::zeros(soft.size(), CV_8U);
  for (int y = 0; y < soft.rows; ++y)
    for (int x = 0; x < soft.cols; ++x)
      if (soft.at<uchar>(y, x) != 0 && touches[static_cast<std::size_t>(labels.at<int>(y, x))] != 0)
        result.at<uchar>(y, x) = 255;
  return result;
}

/// What the frame usually is off the background, of those pixels that are no piece.
double noise_of(const cv::Mat& distance, double most) {
  std::vector<float> values;
  for (const cv::Point& place : frame_of(distance.size()))
    if (distance.at<float>(place) < most) values.push_back(distance.at<float>(place));
  return median(values);
}

/// \param strip  distances of the outermost row and the next few inwards
/// \return 255 where the row belongs to a piece
cv::Mat pieces_in_row(const cv::Mat& strip) {
  cv::Mat most;
  cv::reduce(strip.rowRange(1, strip.rows), most, 0, cv::REDUCE_MAX);
  cv::Mat piece = strip.row(0) >= kOutside * most;
  cv::morphologyEx(piece, piece, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {kStroke, 1}));
  return piece;
}

}  // namespace

cv::Mat distance_from(const Background& background, const cv::Mat& image) {
  const cv::Vec3f brightest = background.brightest();
  cv::Mat distance(image.size(), CV_32F);
  for_rows(image, [&](int y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3f behind = background.colour(x, y);
      const auto& pixel = image.at<cv::Vec3f>(y, x);
      float sum = 0.0F;
      for (int c = 0; c < 3; ++c) {
        const float lit =
            background.plain() ? 1.0F : brightest[c] / std::max(behind[c], kLeastLight * brightest[c]);
        const float d = (pixel[c] - behind[c]) * lit;
        sum += d * d;
      }
      distance.at<float>(y, x) = std::sqrt(sum);
    }
  });
  return distance;
}

cv::Mat foreground(const Background& background, const cv::Mat& image, double contrast, double most) {
  cv::Mat smooth;
  cv::GaussianBlur(image, smooth, cv::Size(), kBlur, kBlur, cv::BORDER_REPLICATE);
  const cv::Mat distance = distance_from(background, smooth);
  const double least = std::min(
      most, std::max({kLeastDistance, kNoiseFactor * noise_of(distance, most), kRinging * contrast}));
  const cv::Mat bare = distance < least;
  const cv::Mat shaded = touching(shades(background, smooth, distance), bare);
  const cv::Mat all = ~bare;
  cv::Mat lit = all & ~shaded;
  return cv::countNonZero(lit) < kLeastLeft * cv::countNonZero(all) ? all : lit;
}

void clear_frame(const cv::Mat& distance, cv::Mat& mask) {
  const int rows = distance.rows;
  const int columns = distance.cols;
  if (std::min(rows, columns) <= kInwards) return;
  cv::Mat strip;
  mask.row(0) &= pieces_in_row(distance.rowRange(0, kInwards + 1));
  cv::flip(distance.rowRange(rows - kInwards - 1, rows), strip, 0);
  mask.row(rows - 1) &= pieces_in_row(strip);
  cv::transpose(distance.colRange(0, kInwards + 1), strip);
  mask.col(0) &= pieces_in_row(strip).t();
  cv::transpose(distance.colRange(columns - kInwards - 1, columns), strip);
  cv::flip(strip, strip, 0);
  mask.col(columns - 1) &= pieces_in_row(strip).t();
}

}  // namespace rejoin::outline::detail
