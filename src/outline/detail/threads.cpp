#include "outline/detail/threads.hpp"

#include <algorithm>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <set>

namespace rejoin::outline::detail {
namespace {

constexpr int kDisc = 5;               // pixels across: what holds no such disc is narrow
constexpr double kLeastLength = 20.0;  // pixels, and
constexpr double kLeastSlender = 8.0;  // times its mean width
constexpr double kMostBeside = 0.25;   // of its pixels lie beside what is wide: more is a border's roughness
constexpr double kLeastReach = 8.0;    // pixels from what is wide: a ragged border's strips lie along it
constexpr int kAround = 40;  // pixels around a narrow region, in which is looked for what it hangs on
constexpr double kLeastDepth =
    12.0;  // pixels that the border is away somewhere in what it hangs on: print is narrower

/// What is known of one narrow region.
struct Narrow {
  double pixels = 0;
  double width = 0;   // mean
  double beside = 0;  // pixels next to something wide
  double reach = 0;   // farthest from what is wide, at
  cv::Point tip;

  double length() const { return pixels / width; }
};

cv::Mat distances(const cv::Mat& mask) {
  cv::Mat distance;
  cv::distanceTransform(mask, distance, cv::DIST_L2, cv::DIST_MASK_3);
  return distance;
}

/// Whether one of the wide regions that a narrow one touches is as deep as a piece.
bool hangs_on_piece(const cv::Mat& narrow, const cv::Mat& wide) {
  cv::Mat around;
  cv::dilate(narrow, around, cv::Mat());
  cv::Mat labels;
  cv::connectedComponents(wide, labels, 8, CV_32S);
  const cv::Mat touched = around & wide;
  const cv::Mat deep = distances(wide) >= kLeastDepth;
  std::set<int> beside;
  std::set<int> pieces;
  for (int y = 0; y < wide.rows; ++y) {
    for (int x = 0; x < wide.cols; ++x) {
      if (touched.at<uchar>(y, x) != 0) beside.insert(labels.at<int>(y, x));
      if (deep.at<uchar>(y, x) != 0) pieces.insert(labels.at<int>(y, x));
    }
  }
  return std::ranges::any_of(beside, [&](int label) { return pieces.contains(label); });
}

/// \param narrow  one region   \param wide  what surrounds it
Narrow measured(const cv::Mat& narrow, const cv::Mat& wide) {
  Narrow region;
  region.pixels = cv::countNonZero(narrow);
  // Of a strip w wide the mean distance from its sides is (w + 1) / 4 or a little more, taken at the pixels' centres.
  region.width = std::max(1.0, 4.0 * cv::mean(distances(narrow), narrow)[0] - 1.0);
  cv::minMaxLoc(distances(~wide), nullptr, &region.reach, nullptr, &region.tip, narrow);
  cv::Mat around;
  cv::dilate(wide, around, cv::Mat());
  region.beside = cv::countNonZero(around & narrow);
  return region;
}

/// Whether a region is as slender as a thread and leads away from what is wide.
bool looks_like_thread(const Narrow& narrow) {
  return narrow.reach >= kLeastReach && narrow.length() >= kLeastLength &&
         narrow.length() >= kLeastSlender * narrow.width && narrow.beside <= kMostBeside * narrow.pixels;
}

}  // namespace

std::vector<Thread> take_off_threads(cv::Mat& field) {
  const cv::Mat mask = field >= 0.5;
  cv::Mat wide;
  cv::morphologyEx(mask, wide, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_ELLIPSE, {kDisc, kDisc}));
  cv::Mat labels;
  cv::Mat boxes;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(mask & ~wide, labels, boxes, centres, 8, CV_32S);
  std::vector<Thread> threads;
  for (int label = 1; label < count; ++label) {
    const int* box = boxes.ptr<int>(label);
    if (box[cv::CC_STAT_AREA] < kLeastLength) continue;
    const cv::Rect window =
        cv::Rect(box[cv::CC_STAT_LEFT] - kAround, box[cv::CC_STAT_TOP] - kAround,
                 box[cv::CC_STAT_WIDTH] + 2 * kAround, box[cv::CC_STAT_HEIGHT] + 2 * kAround) &
        cv::Rect({0, 0}, field.size());
    const cv::Mat narrow = labels(window) == label;
    const Narrow region = measured(narrow, wide(window));
    if (!looks_like_thread(region) || !hangs_on_piece(narrow, wide(window))) continue;
    threads.push_back({region.tip + window.tl(), region.length()});
    field(window).setTo(0.0F, narrow);
  }
  std::ranges::stable_sort(threads, std::ranges::greater{}, &Thread::length);
  return threads;
}

}  // namespace rejoin::outline::detail
