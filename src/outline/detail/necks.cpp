#include "outline/detail/necks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/components.hpp"

namespace rejoin::outline::detail {
namespace {

/// Each part's largest disc is at least so many times as wide as the neck.
constexpr float kWider = 2.5F;
/// Cells of several pixels are looked at in larger pictures than this.
constexpr double kMostCells = 1e6;

/// Squares of pixels: the largest distance from the border in each, and the region of that pixel.
struct Cells {
  int side = 1;
  cv::Mat depth;   ///< CV_32F, 0: in no region
  cv::Mat region;  ///< CV_32S
};

Cells cells_of(const cv::Mat& mask) {
  cv::Mat depth;
  cv::distanceTransform(mask, depth, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat region;
  cv::connectedComponents(mask, region, 8, CV_32S);
  Cells cells;
  cells.side = std::max(1, cvCeil(std::sqrt(static_cast<double>(mask.total()) / kMostCells)));
  if (cells.side == 1) {
    cells.depth = depth;
    cells.region = region;
    return cells;
  }
  const cv::Size size((mask.cols + cells.side - 1) / cells.side, (mask.rows + cells.side - 1) / cells.side);
  cells.depth = cv::Mat::zeros(size, CV_32F);
  cells.region = cv::Mat::zeros(size, CV_32S);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const cv::Point cell(x / cells.side, y / cells.side);
      if (depth.at<float>(y, x) <= cells.depth.at<float>(cell)) continue;
      cells.depth.at<float>(cell) = depth.at<float>(y, x);
      cells.region.at<int>(cell) = region.at<int>(y, x);
    }
  }
  return cells;
}

/// Grows the parts of all regions from their deepest cells outwards.  Where two meet that are wide and the place is narrow they stay two, with
/// a line of cells between them that belong to neither (watersheds of the distance transform).
class Parts {
 public:
  Parts(const Cells& cells, float least_depth)
      : cells_(cells), least_depth_(least_depth), order_(deepest_first(cells.depth)), part_(order_.size()) {
    rank_ = cv::Mat(cells.depth.size(), CV_32S, cv::Scalar(-1));
    for (std::size_t k = 0; k < order_.size(); ++k) add(k);
  }

  std::vector<Neck> necks() const {
    std::vector<Neck> result;
    for (const auto& [parts, neck] : necks_) result.push_back(neck);
    std::ranges::sort(result, {}, [](const Neck& neck) { return std::pair(neck.place.y, neck.place.x); });
    return result;
  }

 private:
  static std::vector<cv::Point> deepest_first(const cv::Mat& depth) {
    std::vector<cv::Point> order;
    for (int y = 0; y < depth.rows; ++y)
      for (int x = 0; x < depth.cols; ++x)
        if (depth.at<float>(y, x) > 0.0F) order.emplace_back(x, y);
    std::ranges::stable_sort(order, [&](const cv::Point& a, const cv::Point& b) {
      return depth.at<float>(a) > depth.at<float>(b);
    });
    return order;
  }

  /// Parts beside a cell, the deepest first; each is named by the rank of its deepest cell.
  std::vector<std::uint32_t> parts_beside(const cv::Point& cell) {
    std::vector<std::uint32_t> parts;
    for (int y = std::max(cell.y - 1, 0); y <= std::min(cell.y + 1, rank_.rows - 1); ++y) {
      for (int x = std::max(cell.x - 1, 0); x <= std::min(cell.x + 1, rank_.cols - 1); ++x) {
        if (rank_.at<int>(y, x) < 0 || cells_.region.at<int>(y, x) != cells_.region.at<int>(cell)) continue;
        parts.push_back(part_.of(static_cast<std::uint32_t>(rank_.at<int>(y, x))));
      }
    }
    std::ranges::sort(parts);
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
  }

  void add(std::size_t k) {
    const cv::Point cell = order_[k];
    const float depth = cells_.depth.at<float>(cell);
    std::vector<std::uint32_t> parts = parts_beside(cell);
    const float deepest = parts.size() > 1 ? cells_.depth.at<float>(order_[parts[1]]) : 0.0F;
    if (parts.size() > 1 && deepest >= std::max(least_depth_, kWider * depth)) {
      Neck& neck = necks_[{parts[0], parts[1]}];
      if (neck.cut.empty()) {
        neck.place = cell * cells_.side;
        neck.width = 2.0 * depth;
        neck.wider = deepest / depth;
      }
      neck.cut.emplace_back(cell * cells_.side, cv::Size(cells_.side, cells_.side));
      return;
    }
    rank_.at<int>(cell) = static_cast<int>(k);
    for (const std::uint32_t part : parts) part_.unite(part, static_cast<std::uint32_t>(k));
  }

  const Cells& cells_;
  float least_depth_;
  std::vector<cv::Point> order_;
  Components part_;
  cv::Mat rank_;  // place of each cell in the order; -1 if it has no part yet
  std::map<std::pair<std::uint32_t, std::uint32_t>, Neck> necks_;
};

}  // namespace

std::vector<Neck> necks(const cv::Mat& mask, double least) {
  const Cells cells = cells_of(mask);
  return Parts(cells, static_cast<float>(std::sqrt(least / std::numbers::pi))).necks();
}

}  // namespace rejoin::outline::detail
