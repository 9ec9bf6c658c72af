#include "outline/detail/distance_grid.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace rejoin::outline::detail {
namespace {

constexpr int kMargin = 4;        ///< cells around the piece
constexpr double kPlaces = 96.0;  ///< along the longer side
constexpr double kMostCells = 512.0;
constexpr int kSubpixelBits = 4;

}  // namespace

DistanceGrid::DistanceGrid(const Outline& outline, double cell) {
  glm::dvec2 high = outline.points[0];
  low_ = high;
  for (const glm::dvec2& p : outline.points) {
    low_ = glm::min(low_, p);
    high = glm::max(high, p);
  }
  const glm::dvec2 size = high - low_;
  const double longer = std::max(size.x, size.y);
  cell_ = std::clamp(cell, longer / kMostCells, longer / kPlaces);
  const int every = std::max(1, static_cast<int>(std::lround(longer / kPlaces / cell_)));
  area_of_place_ = every * every * cell_ * cell_;
  low_ -= glm::dvec2(kMargin * cell_);
  columns_ = static_cast<int>(std::ceil(size.x / cell_)) + 2 * kMargin;
  rows_ = static_cast<int>(std::ceil(size.y / cell_)) + 2 * kMargin;
  const auto pixels = [&](const std::vector<glm::dvec2>& polygon) {
    std::vector<cv::Point> result;
    result.reserve(polygon.size());
    for (const glm::dvec2& p : polygon) {
      const glm::dvec2 at = ((p - low_) / cell_ - 0.5) * static_cast<double>(1 << kSubpixelBits);
      result.emplace_back(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
    }
    return result;
  };
  std::vector<std::vector<cv::Point>> polygons{pixels(outline.points)};
  for (const auto& hole : outline.holes) polygons.push_back(pixels(hole));
  cv::Mat mask(rows_, columns_, CV_8U, cv::Scalar(0));
  cv::fillPoly(mask, polygons, cv::Scalar(255), cv::LINE_8, kSubpixelBits);
  cv::Mat inner;
  cv::Mat outer;
  cv::distanceTransform(mask, inner, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(255 - mask, outer, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  depths_.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      const bool in = mask.at<std::uint8_t>(y, x) != 0;
      const float distance = in ? inner.at<float>(y, x) - 0.5F : 0.5F - outer.at<float>(y, x);
      depths_.push_back(distance * static_cast<float>(cell_));
      if (in && x % every == 0 && y % every == 0)
        inside_.push_back(low_ + glm::dvec2(x + 0.5, y + 0.5) * cell_);
    }
  }
}

double DistanceGrid::depth(const glm::dvec2& point) const {
  const glm::dvec2 at = (point - low_) / cell_ - 0.5;
  if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < columns_ - 1 && at.y < rows_ - 1)) return -kMargin * cell_;
  const auto column = static_cast<std::size_t>(at.x);
  const auto row = static_cast<std::size_t>(at.y);
  const double fx = at.x - static_cast<double>(column);
  const double fy = at.y - static_cast<double>(row);
  const float* cell = depths_.data() + row * static_cast<std::size_t>(columns_) + column;
  const double upper = cell[0] * (1.0 - fx) + cell[1] * fx;
  const double lower = cell[columns_] * (1.0 - fx) + cell[columns_ + 1] * fx;
  return upper * (1.0 - fy) + lower * fy;
}

}  // namespace rejoin::outline::detail
