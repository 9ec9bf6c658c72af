#include "match/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "core/error.hpp"

namespace rejoin::match {
namespace {

constexpr double kHalfPixel = 0.5;

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

/// Row after row: whole pixels.
std::vector<glm::dvec2> shifts_covering(const cv::Mat& overlap, double least, const zbuffer::DepthMap& map) {
  std::vector<glm::dvec2> shifts;
  for (int y = 0; y < overlap.rows; ++y) {
    for (int x = 0; x < overlap.cols; ++x) {
      if (overlap.at<float>(y, x) >= least)
        shifts.emplace_back(as_signed(x, overlap.cols, map.width), as_signed(y, overlap.rows, map.height));
    }
  }
  return shifts;
}

/// The first one of several that are as near.
glm::dvec2 nearest(const std::vector<glm::dvec2>& shifts, const glm::dvec2& place) {
  return *std::ranges::min_element(
      shifts, {}, [&](const glm::dvec2& shift) { return glm::dot(shift - place, shift - place); });
}

/// \pre not shifts.empty()
glm::dvec2 middle_of(const std::vector<glm::dvec2>& shifts, const std::optional<glm::dvec2>& near_px) {
  glm::dvec2 middle(0.0);
  for (const glm::dvec2& shift : shifts) middle += shift;
  middle /= static_cast<double>(shifts.size());
  const glm::dvec2 off = glm::abs(nearest(shifts, middle) - middle);
  const bool covers = std::max(off.x, off.y) <= kHalfPixel;
  return covers ? middle : nearest(shifts, near_px.value_or(middle));
}

}  // namespace

SilhouettePeak best_silhouette_shift(const zbuffer::DepthMap& a, const zbuffer::DepthMap& b,
                                     const std::optional<glm::dvec2>& near_px) {
  if (a.width != b.width || a.height != b.height) throw InputError("depth maps", "their shapes differ");
  const cv::Size plane(cv::getOptimalDFTSize(2 * a.width - 1), cv::getOptimalDFTSize(2 * a.height - 1));
  cv::Mat product;
  cv::mulSpectrums(spectrum_of(b, true, plane), spectrum_of(a, false, plane), product, 0, true);
  cv::Mat overlap;
  cv::dft(product, overlap, cv::DFT_INVERSE | cv::DFT_SCALE);
  double most = 0;
  cv::minMaxLoc(overlap, nullptr, &most);
  // Overlaps are whole numbers; the transform's rounding is far below this.
  constexpr double kHalfOverlap = 0.5;
  if (most < kHalfOverlap) return {};
  return {middle_of(shifts_covering(overlap, most - kHalfOverlap, a), near_px), std::round(most)};
}

}  // namespace rejoin::match
