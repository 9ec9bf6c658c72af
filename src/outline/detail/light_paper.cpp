#include "outline/detail/light_paper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/median.hpp"

namespace rejoin::outline::detail {
namespace {

/// The border lies in so many of the outermost pixels of the foreground.
constexpr float kOutermost = 6.0F;
/// So far inside from where the border usually is, and where most of the piece has this share of the contrast, a pixel has the piece's own
/// colour, be it print's,
constexpr double kPastBorder = 1.5;
constexpr double kFull = 0.9;
constexpr double kPastBlur = 0.5;
/// if its distance is this share of the contrast, at least.
constexpr double kLeastOfContrast = 0.15;
/// There is print where it is less than the one share of the contrast, or more than the other.
constexpr double kLessByPrint = 0.8;
constexpr double kMoreByPrint = 1.2;
constexpr double kLeastOfPrint = 0.04;  // distance that print has
/// So far from what is lit its light counts in the contrast, pixels.
constexpr int kLitNear = 6;
/// Print is narrower, pixels.
constexpr int kWidestPrint = 9;

/// Those regions of a mask of whose pixels that count most have a vote.
/// \param counted, votes  CV_8U, 255 where a pixel counts, where it has a vote
cv::Mat regions_of_most(const cv::Mat& mask, const cv::Mat& counted, const cv::Mat& votes) {
  cv::Mat labels;
  const auto count = static_cast<std::size_t>(cv::connectedComponents(mask, labels, 8, CV_32S));
  const auto region_at = [&](int x, int y) { return static_cast<std::size_t>(labels.at<int>(y, x)); };
  std::vector<std::int64_t> balance(count, 0);
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (counted.at<std::uint8_t>(y, x) != 0)
        balance[region_at(x, y)] += votes.at<std::uint8_t>(y, x) != 0 ? 1 : -1;
  cv::Mat result = mask.clone();
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (balance[region_at(x, y)] <= 0) result.at<std::uint8_t>(y, x) = 0;
  return result;
}

/// How deep in what is lit the border lies, and the colour is the piece's own, usually, pixels.
struct Depths {
  double border;
  double full;
};

/// \return nothing where a border is too blurred
std::optional<Depths> usual_depths(const cv::Mat& share, const cv::Mat& depth) {
  constexpr float kStep = 0.5F;
  std::array<std::vector<float>, static_cast<std::size_t>(kOutermost / kStep)> shares;
  for (int y = 0; y < share.rows; ++y) {
    for (int x = 0; x < share.cols; ++x) {
      const float at = depth.at<float>(y, x);
      if (at > 0.0F && at < kOutermost)
        shares[static_cast<std::size_t>(at / kStep)].push_back(share.at<float>(y, x));
    }
  }
  std::optional<double> border;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double usual = shares[k].empty() ? 0.0 : median(shares[k]);
    if (!border && usual >= 0.5) border = kStep * static_cast<double>(k);
    if (usual >= kFull) return Depths{*border, kStep * static_cast<double>(k)};
  }
  return {};
}

/// Distance from the background that the nearest pixel of those `inside` and deeper has; 0 where none is as near as that.
cv::Mat distance_inside(const cv::Mat& distance, const cv::Mat& depth, float inside) {
  const cv::Mat outer = depth < inside;
  cv::Mat away;
  cv::Mat labels;
  cv::distanceTransform(outer, away, labels, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<float> known(outer.total() - static_cast<std::size_t>(cv::countNonZero(outer)) + 1, 0.0F);
  cv::Mat soft;
  cv::blur(distance, soft, {3, 3});
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (outer.at<std::uint8_t>(y, x) == 0)
        known[static_cast<std::size_t>(labels.at<int>(y, x))] = soft.at<float>(y, x);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      soft.at<float>(y, x) = away.at<float>(y, x) <= inside + 1.0F
                                 ? known[static_cast<std::size_t>(labels.at<int>(y, x))]
                                 : 0.0F;
    }
  }
  return soft;
}

/// What is as near to lit places as their light reaches in the contrast.
cv::Mat beside(const cv::Mat& lit) {
  cv::Mat near;
  cv::dilate(lit, near, cv::getStructuringElement(cv::MORPH_RECT, {2 * kLitNear + 1, 2 * kLitNear + 1}));
  return near;
}

}  // namespace

LightPaper light_paper(const Foreground& found, const cv::Mat& faint) {
  const cv::Mat pieces = regions_of_most(found.mask, found.mask, ~found.dim);
  LightPaper result;
  if (cv::countNonZero(pieces) == 0) return result;
  result.lit = pieces & ~found.dim;
  cv::Mat closed;
  cv::morphologyEx(result.lit, closed, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {kWidestPrint, kWidestPrint}));
  // A shadow lies all along an edge, and is faint beside it.
  result.shadow = regions_of_most(touching(pieces & ~closed, ~found.mask), beside(result.lit), faint);
  return result;
}

void tell_print(const cv::Mat& distance, const cv::Mat& contrast, const cv::Mat& lit, cv::Mat& share) {
  cv::Mat depth;
  cv::distanceTransform(lit, depth, cv::DIST_L2, cv::DIST_MASK_5);
  const std::optional<Depths> usual = usual_depths(share, depth);
  if (!usual) return;
  const auto inside = static_cast<float>(std::max(usual->border + kPastBorder, usual->full + kPastBlur));
  if (inside >= kOutermost) return;
  const cv::Mat own = distance_inside(distance, depth, inside);
  const cv::Mat fainter = (own > kLeastOfContrast * contrast) & (own < kLessByPrint * contrast);
  const cv::Mat print = lit & (fainter | (own > kMoreByPrint * contrast));
  cv::Mat of_own;
  cv::divide(distance, cv::max(own, kLeastOfPrint), of_own);
  of_own = cv::min(of_own, 1.0);
  of_own.copyTo(share, print);
  share.setTo(1.0, print & (depth >= inside));
}

}  // namespace rejoin::outline::detail
