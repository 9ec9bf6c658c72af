#include "outline/detail/torn_core.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/median.hpp"

namespace rejoin::outline::detail {
namespace {

// Pixels this deep in a piece are free of the background's colour and still core.
constexpr float kRimFrom = 2.0F;
constexpr float kRimTo = 4.0F;
constexpr float kLeastBright = 0.7F;     // of the core, its darkest channel
constexpr float kMostHue = 0.15F;        // its channels differ by less
constexpr float kSame = 0.1F;            // colours that are less apart are one
constexpr double kLeastRim = 0.04;       // of the rim's pixels are core
constexpr double kMostInside = 0.25;     // of the rim's share, inside the pieces
constexpr double kMostWhite = 0.35;      // of what lies inside may have its colour anyhow: sky, not a page
constexpr double kWidest = 0.1;          // of the root of the pieces' mean area
constexpr double kWidestOfDepth = 0.25;  // of what a pixel can be inside at most
constexpr int kBeside = 7;  // pixels across, in which the face's colour is looked for beside the core
constexpr float kLeastContrast = 0.12F;

cv::Vec3f colour_at(const cv::Mat& image, int y, int x) {
  const float* pixel = image.ptr<float>(y) + static_cast<std::ptrdiff_t>(x) * image.channels();
  return {pixel[0], pixel[1], pixel[2]};
}

float distance(const cv::Vec3f& x, const cv::Vec3f& y) {
  const cv::Vec3f d = x - y;
  return std::sqrt((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / 3.0F);
}

bool is_white(const cv::Vec3f& c) {
  const auto [least, most] = std::minmax({c[0], c[1], c[2]});
  return least > kLeastBright && most - least < kMostHue;
}

/// What most white pixels of the rim have for a colour; nothing where these are few.
std::optional<cv::Vec3f> colour_of_core(const cv::Mat& image, const cv::Mat& rim) {
  std::array<std::vector<float>, 3> channels;
  std::size_t all = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      if (rim.at<uchar>(y, x) == 0) continue;
      ++all;
      const cv::Vec3f c = colour_at(image, y, x);
      if (!is_white(c)) continue;
      for (int k = 0; k < 3; ++k) channels[static_cast<std::size_t>(k)].push_back(c[k]);
    }
  }
  if (static_cast<double>(channels[0].size()) < kLeastRim * static_cast<double>(all) || all == 0)
    return std::nullopt;
  return cv::Vec3f{median(channels[0]), median(channels[1]), median(channels[2])};
}

double share_of(const cv::Mat& what, const cv::Mat& among) {
  const int all = cv::countNonZero(among);
  return all == 0 ? 0.0 : static_cast<double>(cv::countNonZero(what & among)) / all;
}

/// How far each pixel of a mask is from its border, pixels; 0 outside.
cv::Mat depth_in(const cv::Mat& mask) {
  cv::Mat depth;
  cv::distanceTransform(mask, depth, cv::DIST_L2, cv::DIST_MASK_5);
  return depth;
}

/// What no disc that lies within the mask covers.  A white margin, a page and a bright sky hold discs, a rim of core does not.
cv::Mat narrow_parts(const cv::Mat& mask, double width) {
  const double radius = 0.5 * width;
  const cv::Mat far = depth_in(mask) <= radius;  // from the middles of all such discs
  return mask & (depth_in(far) > radius);
}

/// The parts of a mask that reach into another.
cv::Mat parts_in(const cv::Mat& mask, const cv::Mat& other) {
  cv::Mat labels;
  const int parts = cv::connectedComponents(mask, labels, 8, CV_32S);
  std::vector<bool> reaches(static_cast<std::size_t>(parts), false);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (other.at<uchar>(y, x) != 0) reaches[static_cast<std::size_t>(labels.at<int>(y, x))] = true;
  cv::Mat result = cv::Mat::zeros(mask.size(), CV_8U);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (mask.at<uchar>(y, x) != 0 && reaches[static_cast<std::size_t>(labels.at<int>(y, x))])
        result.at<uchar>(y, x) = 255;
  return result;
}

int count_of_pieces(const cv::Mat& piece) {
  cv::Mat labels;
  return cv::connectedComponents(piece, labels, 8, CV_32S) - 1;
}

}  // namespace

double take_off_core(const cv::Mat& image, cv::Mat& field) {
  const cv::Mat piece = field > 0.5F;
  const cv::Mat depth = depth_in(piece);
  const cv::Mat rim = (depth > kRimFrom) & (depth < kRimTo);
  const std::optional<cv::Vec3f> core = colour_of_core(image, rim);
  if (!core) return 0.0;
  cv::Mat off(image.size(), CV_32F);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) off.at<float>(y, x) = distance(colour_at(image, y, x), *core);

  double deepest = 0.0;
  cv::minMaxLoc(depth, nullptr, &deepest);
  const double area = static_cast<double>(cv::countNonZero(piece)) / count_of_pieces(piece);
  const double widest = std::min(kWidest * std::sqrt(area), kWidestOfDepth * deepest);
  const cv::Mat alike = (off < kSame) & piece;
  const cv::Mat narrow = narrow_parts(alike, widest);
  const double share = share_of(narrow, rim);
  const cv::Mat inside = depth > 2.0 * widest;
  const bool white_face = share_of(alike, inside) > kMostWhite;
  if (share < kLeastRim || white_face || share_of(narrow, inside) > kMostInside * share) return 0.0;

  const cv::Mat mixed = (depth > 0.0F) & (depth <= kRimFrom) & (off < 2.0F * kSame);  // with the background
  cv::Mat near = parts_in((narrow & (depth < widest)) | mixed, narrow & rim);
  const cv::Mat neighbours = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::dilate(near, near, neighbours);

  // The face's border, half-way between the two colours.
  off.setTo(0.0, depth <= kRimFrom);
  cv::Mat contrast;
  cv::dilate(off, contrast, cv::getStructuringElement(cv::MORPH_RECT, {kBeside, kBeside}));
  for (int y = 0; y < field.rows; ++y) {
    for (int x = 0; x < field.cols; ++x) {
      if (near.at<uchar>(y, x) == 0) continue;
      const float of_face =
          distance(colour_at(image, y, x), *core) / std::max(contrast.at<float>(y, x), kLeastContrast);
      field.at<float>(y, x) = std::min(field.at<float>(y, x), of_face);
    }
  }
  return share;
}

}  // namespace rejoin::outline::detail
