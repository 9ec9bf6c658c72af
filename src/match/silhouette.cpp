#include "match/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/error.hpp"

namespace rejoin::match {
namespace {

// 1 where covered, in the corner of a plane that is large enough for shifts without wrap-around.
cv::Mat spectrum_of(const zbuffer::DepthMap& map, bool mirror, const cv::Size& plane) {
  cv::Mat covered = cv::Mat::zeros(plane, CV_32F);
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const float depth = map.at(mirror ? map.width - 1 - i : i, j);
      if (!std::isnan(depth)) covered.at<float>(j, i) = 1.0F;
    }
  }
  cv::Mat spectrum;
  cv::dft(covered, spectrum, 0, map.height);
  return spectrum;
}

int as_signed(int index, int size, int reach) {
  return index < reach ? index : index - size;
}

}  // namespace

SilhouettePeak best_silhouette_shift(const zbuffer::DepthMap& a, const zbuffer::DepthMap& b) {
  if (a.width != b.width || a.height != b.height) throw InputError("depth maps", "their shapes differ");
  const cv::Size plane(cv::getOptimalDFTSize(2 * a.width - 1), cv::getOptimalDFTSize(2 * a.height - 1));
  cv::Mat product;
  cv::mulSpectrums(spectrum_of(b, true, plane), spectrum_of(a, false, plane), product, 0, true);
  cv::Mat overlap;
  cv::dft(product, overlap, cv::DFT_INVERSE | cv::DFT_SCALE);
  double most = 0;
  cv::minMaxLoc(overlap, nullptr, &most);
  constexpr double kHalfPixel =
      0.5;  // overlaps are whole numbers; the transform's rounding is far below this
  if (most < kHalfPixel) return {};
  glm::dvec2 sum(0.0);
  int count = 0;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      if (overlap.at<float>(y, x) < most - kHalfPixel) continue;
      sum += glm::dvec2(as_signed(x, plane.width, a.width), as_signed(y, plane.height, a.height));
      ++count;
    }
  }
  return {sum / static_cast<double>(count), std::round(most)};
}

}  // namespace rejoin::match
