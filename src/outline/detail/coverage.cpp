#include "outline/detail/coverage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "outline/detail/background.hpp"
#include "outline/detail/foreground.hpp"
#include "outline/detail/light_paper.hpp"
#include "outline/detail/picture_edges.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kBins = 1024;
/// Least difference in colour between pieces and background, 0..1 a channel.
constexpr double kLeastContrast = 0.04;
/// The background is plain if no more than this share of the frame is a piece or something else.
constexpr double kMostOfFrame = 0.6;

// Borders lie in the outermost pixels of the foreground: where the colour is half-way from the background's to that of the piece
// beside it, which is a mean over some pixels farther inside.
constexpr float kBorderBand = 6.0F;
/// The foreground reaches less than this beyond the border, where the share of the contrast is,
constexpr float kBeyond = 2.0F;
/// if it is a border, more than this at that depth.
constexpr float kLeastShare = 0.4F;
constexpr int kInside = 5;
constexpr int kBeside = 15;
/// Print narrower than this does not end a piece, pixels.
constexpr int kStroke = 9;

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

cv::Mat square(int side) {
  return cv::getStructuringElement(cv::MORPH_RECT, {side, side});
}

/// Distance that the piece beside a pixel has: the geometric mean, as print is several times nearer to the background than its
/// piece, or farther.
cv::Mat contrast_beside(const cv::Mat& distance, const cv::Mat& mask, double least) {
  cv::Mat inside;
  cv::erode(mask, inside, square(kInside));
  cv::Mat weight;
  inside.convertTo(weight, CV_32F, 1.0 / 255.0);
  cv::Mat sum;
  cv::log(cv::max(distance, least), sum);
  cv::multiply(sum, weight, sum);
  cv::boxFilter(sum, sum, CV_32F, {kBeside, kBeside}, {-1, -1}, false);
  cv::boxFilter(weight, weight, CV_32F, {kBeside, kBeside}, {-1, -1}, false);
  cv::Mat contrast;
  cv::dilate(distance, contrast, square(kInside));  // of what is too narrow to have an inside
  cv::divide(sum, weight, sum);
  cv::exp(sum, sum);
  sum.copyTo(contrast, weight > 0.5F);
  return cv::max(contrast, least);
}

/// The border at half the contrast, print at the border taken for piece.
cv::Mat field_of(const cv::Mat& distance, const Foreground& found) {
  const cv::Mat contrast = contrast_beside(distance, found.mask, kLeastContrast);
  cv::Mat share;
  cv::divide(distance, contrast, share);
  share = cv::min(share, 1.0);
  const LightPaper paper = light_paper(found, share < kLeastShare);
  if (!paper.lit.empty()) tell_print(distance, contrast, paper.lit, share);
  cv::Mat field = share.clone();
  cv::Mat scratch;
  cv::morphologyEx(share, scratch, cv::MORPH_CLOSE, square(kStroke));
  cv::Mat depth;
  cv::distanceTransform(found.mask, depth, cv::DIST_L2, cv::DIST_MASK_3);
  scratch.copyTo(field, (depth > kBeyond) & (share < kLeastShare));
  field.setTo(1.0, depth > kBorderBand);
  if (!paper.shadow.empty()) cv::Mat(cv::min(share, kLeastShare)).copyTo(field, paper.shadow);
  cv::dilate(found.mask, scratch, square(kInside));
  field.setTo(0.0, ~scratch);
  return field;
}

double share_of_frame_above(const cv::Mat& field, double level) {
  const std::vector<cv::Point> frame = frame_of(field.size());
  const auto above = std::count_if(frame.begin(), frame.end(),
                                   [&](const cv::Point& place) { return field.at<float>(place) > level; });
  return static_cast<double>(above) / static_cast<double>(frame.size());
}

Coverage coverage_from_background(cv::Mat& image, const std::string& path) {
  const std::string edges = paint_over_edges(image);
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
  Foreground found = foreground(background, image, classes.high_mean, classes.threshold);
  clear_frame(distance, found.mask);
  Coverage result{field_of(distance, found), distance, {}};
  result.field.setTo(0.0, found.shadow);
  result.distance.setTo(0.0, found.shadow);
  if (!edges.empty()) result.notes.push_back(edges);
  if (!background.plain()) {
    constexpr double kAsBright = 0.995;  // a change of colour alone
    const bool darker = background.darkest() < kAsBright;
    result.notes.push_back(
        fmt::format("the background's {} over the picture, which is evened out",
                    darker ? fmt::format("light changes from 100 to {:.0f} %", 100.0 * background.darkest())
                           : "colour changes"));
  }
  return result;
}

}  // namespace

Coverage coverage(cv::Mat& image, const std::string& path) {
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
  return {alpha, {}, {}};
}

}  // namespace rejoin::outline::detail
