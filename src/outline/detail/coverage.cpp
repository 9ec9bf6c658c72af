#include "outline/detail/coverage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "outline/detail/background.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kBins = 1024;
/// A mask without soft edges has a staircase border; this takes the steps off (pixels, standard deviation).
constexpr double kStaircaseBlur = 0.7;
/// Least difference in colour between pieces and background, 0..1 a channel.
constexpr double kLeastContrast = 0.04;
/// The background is plain if no more than this share of the frame is a piece or something else.
constexpr double kMostOfFrame = 0.6;
/// Light weaker than this share of the brightest is not made up for further.
constexpr float kLeastLight = 0.1F;

struct Classes {
  double threshold = 0.0;
  double low_mean = 0.0;
  double high_mean = 0.0;
};

/// Otsu's threshold: it leaves the most variance between the two classes.
Classes otsu(const cv::Mat& values, double top) {
  std::array<double, kBins> counts{};
  for (int y = 0; y < values.rows; ++y) {
    for (int x = 0; x < values.cols; ++x) {
      const double bin = values.at<float>(y, x) / top * kBins;
      counts[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))] += 1.0;
    }
  }
  double total = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < kBins; ++i) {
    total += counts[i];
    sum += counts[i] * (static_cast<double>(i) + 0.5);
  }
  Classes best;
  double best_variance = -1.0;
  double low = 0.0;
  double low_sum = 0.0;
  for (std::size_t i = 0; i + 1 < kBins; ++i) {
    low += counts[i];
    low_sum += counts[i] * (static_cast<double>(i) + 0.5);
    if (low == 0.0 || low == total) continue;
    const double means = low_sum / low - (sum - low_sum) / (total - low);
    const double variance = low * (total - low) * means * means;
    if (variance <= best_variance) continue;
    best_variance = variance;
    best = {(static_cast<double>(i) + 1.0) / kBins * top, low_sum / low / kBins * top,
            (sum - low_sum) / (total - low) / kBins * top};
  }
  return best;
}

/// How far each pixel's colour is from the background's, as it would be were all of the picture lit as its brightest frame.
cv::Mat distance_from(const Background& background, const cv::Mat& image) {
  const cv::Vec3f brightest = background.brightest();
  cv::Mat distance(image.size(), CV_32F);
  for (int y = 0; y < image.rows; ++y) {
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
  }
  return distance;
}

double share_of_frame_above(const cv::Mat& field, double level) {
  double above = 0.0;
  double all = 0.0;
  for (int y = 0; y < field.rows; ++y) {
    const bool whole_row = y == 0 || y == field.rows - 1;
    for (int x = 0; x < field.cols; x += whole_row || field.cols == 1 ? 1 : field.cols - 1) {
      above += field.at<float>(y, x) > level ? 1.0 : 0.0;
      all += 1.0;
    }
  }
  return above / all;
}

Coverage coverage_from_background(const cv::Mat& image, const std::string& path) {
  const Background background(image);
  const cv::Mat distance = distance_from(background, image);
  double top = 0.0;
  cv::minMaxLoc(distance, nullptr, &top);
  const Classes classes = top > 0.0 ? otsu(distance, top) : Classes{};
  if (classes.high_mean - classes.low_mean < kLeastContrast) {
    throw InputError(path, "no piece stands out from the background",
                     "scan the pieces on a plain background of another colour");
  }
  if (share_of_frame_above(distance, classes.threshold) > kMostOfFrame) {
    throw InputError(path, "the background is not plain",
                     "leave plain background all around the pieces, or cut them out (alpha)");
  }
  Coverage result;
  if (!background.plain()) {
    result.notes.push_back(fmt::format(
        "the background's light changes from 100 to {:.0f} % over the picture, which is evened out",
        100.0 * background.darkest()));
  }
  distance.convertTo(result.field, CV_32F, 0.5 / classes.threshold);
  result.field = cv::min(result.field, 1.0);
  return result;
}

/// Whether the mask has no values between outside and inside.
bool is_binary(const cv::Mat& alpha) {
  cv::Mat soft;
  cv::inRange(alpha, 0.02, 0.98, soft);
  return cv::countNonZero(soft) == 0;
}

}  // namespace

Coverage coverage(const cv::Mat& image, const std::string& path) {
  if (image.channels() == 3) return coverage_from_background(image, path);
  cv::Mat alpha;
  cv::extractChannel(image, alpha, 3);
  double least = 0.0;
  double most = 0.0;
  cv::minMaxLoc(alpha, &least, &most);
  if (least > 0.5) {
    cv::Mat colours;
    cv::cvtColor(image, colours, cv::COLOR_BGRA2BGR);
    return coverage_from_background(colours, path);
  }
  if (most <= 0.5)
    throw InputError(path, "no piece: every pixel is transparent", "save the picture with its pieces opaque");
  // A padded blur, so that a piece at the picture's border is not drawn inwards.
  if (is_binary(alpha))
    cv::GaussianBlur(alpha, alpha, cv::Size(), kStaircaseBlur, kStaircaseBlur, cv::BORDER_REPLICATE);
  return {alpha, {}};
}

}  // namespace rejoin::outline::detail
