#include "outline/detail/threads.hpp"

#include <algorithm>
#include <cstddef>
#include <opencv2/imgproc.hpp>

namespace rejoin::outline::detail {
namespace {

constexpr int kDisc = 5;               // pixels across: what holds no such disc is narrow
constexpr double kLeastLength = 20.0;  // pixels, and
constexpr double kLeastSlender = 8.0;  // times its mean width
constexpr double kMostBeside = 0.25;   // of its pixels lie beside what is wide: more is a border's roughness
constexpr float kLeastReach = 8.0F;    // pixels from what is wide: a ragged border's strips lie along it
constexpr float kLeastDepth =
    12.0F;  // pixels that the border is away somewhere in what it hangs on: print is narrower

/// What is known of one narrow region.
struct Narrow {
  cv::Point place;
  int pixels = 0;
  int beside = 0;      // pixels next to something wide
  double depth = 0.0;  // sum of the distances from the region's border
  float reach = 0.0F;  // farthest from what is wide
  bool hangs = false;  // on a piece
};

bool is_thread(const Narrow& narrow, double width, double length) {
  return narrow.hangs && narrow.reach >= kLeastReach && length >= kLeastLength &&
         length >= kLeastSlender * width && narrow.beside <= kMostBeside * narrow.pixels;
}

/// How deep each wide region is, by its label.
std::vector<float> depths_of(const cv::Mat& wide, const cv::Mat& labels, int count) {
  cv::Mat depth;
  cv::distanceTransform(wide, depth, cv::DIST_L2, cv::DIST_MASK_3);
  std::vector<float> deepest(static_cast<std::size_t>(count), 0.0F);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      float& most = deepest[static_cast<std::size_t>(labels.at<int>(y, x))];
      most = std::max(most, depth.at<float>(y, x));
    }
  }
  return deepest;
}

/// Narrow regions by their label, the first one being all that is not narrow.
std::vector<Narrow> measured(const cv::Mat& narrow, const cv::Mat& labels, int count, const cv::Mat& wide) {
  cv::Mat wide_labels;
  const int wide_count = cv::connectedComponents(wide, wide_labels, 8, CV_32S);
  const std::vector<float> deepest = depths_of(wide, wide_labels, wide_count);
  cv::Mat depth;
  cv::distanceTransform(narrow, depth, cv::DIST_L2, cv::DIST_MASK_3);
  cv::Mat away;
  cv::distanceTransform(~wide, away, cv::DIST_L2, cv::DIST_MASK_3);
  std::vector<Narrow> regions(static_cast<std::size_t>(count));
  for (int y = 0; y < narrow.rows; ++y) {
    for (int x = 0; x < narrow.cols; ++x) {
      const int label = labels.at<int>(y, x);
      if (label == 0) continue;
      Narrow& region = regions[static_cast<std::size_t>(label)];
      if (region.pixels == 0) region.place = {x, y};
      ++region.pixels;
      region.depth += depth.at<float>(y, x);
      region.reach = std::max(region.reach, away.at<float>(y, x));
      float piece = 0.0F;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, narrow.rows - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, narrow.cols - 1); ++u)
          if (wide.at<uchar>(v, u) != 0)
            piece = std::max(piece, deepest[static_cast<std::size_t>(wide_labels.at<int>(v, u))]);
      if (piece > 0.0F) ++region.beside;
      region.hangs = region.hangs || piece >= kLeastDepth;
    }
  }
  return regions;
}

}  // namespace

std::vector<Thread> take_off_threads(cv::Mat& field) {
  const cv::Mat mask = field >= 0.5;
  cv::Mat wide;
  cv::morphologyEx(mask, wide, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_ELLIPSE, {kDisc, kDisc}));
  const cv::Mat narrow = mask & ~wide;
  cv::Mat labels;
  const int count = cv::connectedComponents(narrow, labels, 8, CV_32S);
  std::vector<Narrow> regions = measured(narrow, labels, count, wide);
  std::vector<Thread> threads;
  for (Narrow& region : regions) {
    if (region.pixels == 0) continue;
    // Of a strip w wide the mean distance from its sides is (w + 1) / 4 or a little more, taken at the pixels' centres.
    const double width = std::max(1.0, 4.0 * region.depth / region.pixels - 1.0);
    const double length = region.pixels / width;
    region.hangs = is_thread(region, width, length);
    if (region.hangs) threads.push_back({region.place, length});
  }
  if (threads.empty()) return threads;
  for (int y = 0; y < field.rows; ++y)
    for (int x = 0; x < field.cols; ++x)
      if (regions[static_cast<std::size_t>(labels.at<int>(y, x))].hangs) field.at<float>(y, x) = 0.0F;
  std::ranges::stable_sort(threads, std::ranges::greater{}, &Thread::length);
  return threads;
}

}  // namespace rejoin::outline::detail
