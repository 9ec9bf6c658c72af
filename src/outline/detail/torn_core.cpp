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
constexpr float kLeastBright = 0.8F;     // of the core, its darkest channel
constexpr float kMostHue = 0.15F;        // its channels differ by less
constexpr float kSame = 0.1F;            // colours that are less apart are one
constexpr double kLeastRim = 0.04;       // of the rim's pixels are core
constexpr double kMostRim = 0.7;         // and not more: the other half of a tear has none
constexpr double kMostInside = 0.25;     // of the rim's share, inside the piece
constexpr double kMostWhite = 0.35;      // of what lies inside may have its colour anyhow: sky, not a page
constexpr double kWidest = 0.1;          // of the root of the piece's area
constexpr double kWidestOfDepth = 0.25;  // of what a pixel can be inside at most
constexpr double kCornerReach = 1.5;     // discs within a right corner leave 0.41 of their radius of it free
// Quartiles of the core's depth lie apart by this share of its median: a margin is even.
constexpr double kUneven = 0.15;
constexpr int kLeastPixels = 1000;      // of a piece that is looked at
constexpr std::size_t kManyPieces = 5;  // pieces of torn print, of which
constexpr double kLeastOfMany = 0.25;   // or more show core: of a sheet torn into ten 9 did
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

/// What discs that lie within the mask do not come near.  A white margin, a page and a bright sky hold discs, a rim of core does not.
cv::Mat narrow_parts(const cv::Mat& mask, double width) {
  const double radius = 0.5 * width;
  const cv::Mat far = depth_in(mask) <= radius;  // from the middles of all such discs
  return mask & (depth_in(far) > kCornerReach * radius);
}

/// Those parts of a mask that are longer along the border than deep; nothing where all together are about as deep everywhere.
/// \param depth  of all pixels in their piece
cv::Mat core_among(const cv::Mat& mask, const cv::Mat& rim, const cv::Mat& depth) {
  cv::Mat labels;
  const auto parts = static_cast<std::size_t>(cv::connectedComponents(mask, labels, 8, CV_32S));
  cv::Mat beside_face;
  cv::dilate((depth > kRimFrom) & ~mask, beside_face, cv::Mat());
  std::vector<float> deepest(parts, 0.0F);
  std::vector<float> depths;
  std::vector<std::size_t> in_rim(parts, 0);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      if (mask.at<uchar>(y, x) == 0) continue;
      const auto part = static_cast<std::size_t>(labels.at<int>(y, x));
      const float deep = depth.at<float>(y, x);
      deepest[part] = std::max(deepest[part], deep);
      if (rim.at<uchar>(y, x) != 0) ++in_rim[part];
      if (beside_face.at<uchar>(y, x) != 0 && deep > kRimFrom) depths.push_back(deep);
    }
  }
  cv::Mat result = cv::Mat::zeros(mask.size(), CV_8U);
  const float spread = quantile(depths, 0.75) - quantile(depths, 0.25);
  if (spread <= kUneven * median(depths)) return result;
  const auto is_core = [&](std::size_t part) {
    return part > 0 && static_cast<float>(in_rim[part]) > (kRimTo - kRimFrom) * deepest[part];
  };
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (is_core(static_cast<std::size_t>(labels.at<int>(y, x)))) result.at<uchar>(y, x) = 255;
  return result;
}

/// How far each pixel is off a colour.
cv::Mat off_colour(const cv::Mat& image, const cv::Vec3f& colour) {
  cv::Mat off(image.size(), CV_32F);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) off.at<float>(y, x) = distance(colour_at(image, y, x), colour);
  return off;
}

/// The widest that a piece's core may be, pixels.
double widest_core(const cv::Mat& piece, const cv::Mat& depth) {
  double deepest = 0.0;
  cv::minMaxLoc(depth, nullptr, &deepest);
  return std::min(kWidest * std::sqrt(static_cast<double>(cv::countNonZero(piece))),
                  kWidestOfDepth * deepest);
}

cv::Mat rim_of(const cv::Mat& depth) {
  return (depth > kRimFrom) & (depth < kRimTo);
}

/// \param piece  CV_8U, the pixels of one piece   \return whether core was taken off
bool take_off_one(const cv::Mat& image, const cv::Mat& piece, cv::Mat field) {
  const cv::Mat depth = depth_in(piece);
  const cv::Mat rim = rim_of(depth);
  const std::optional<cv::Vec3f> core = colour_of_core(image, rim);
  if (!core) return false;
  cv::Mat off = off_colour(image, *core);
  const double widest = widest_core(piece, depth);
  const cv::Mat alike = (off < kSame) & piece;
  const cv::Mat narrow = narrow_parts(alike, widest);
  const cv::Mat inside = depth > 2.0 * widest;
  const double share = share_of(narrow, rim);
  const bool white_face = share_of(alike, inside) > kMostWhite;
  if (share < kLeastRim || share > kMostRim || white_face || share_of(narrow, inside) > kMostInside * share)
    return false;

  const cv::Mat mixed = (depth > 0.0F) & (depth <= kRimFrom) & (off < 2.0F * kSame);  // with the background
  cv::Mat taken = core_among((narrow & (depth < widest)) | mixed, rim, depth);
  if (cv::countNonZero(taken) == 0) return false;
  // Out to the border, where colours are mixed with the background's: what is nearer to core than to the face.
  const cv::Mat face = (depth > kRimFrom) & ~taken;
  cv::Mat beside;
  cv::dilate(piece, beside, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  const cv::Mat outer = beside & (depth <= kRimFrom) & (depth_in(~taken) < depth_in(~face));
  field.setTo(0.0, outer);
  cv::dilate(taken, taken, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  // The face's border, half-way between the two colours.
  off.setTo(0.0, depth <= kRimFrom);
  cv::Mat contrast;
  cv::dilate(off, contrast, cv::getStructuringElement(cv::MORPH_RECT, {kBeside, kBeside}));
  for (int y = 0; y < field.rows; ++y) {
    for (int x = 0; x < field.cols; ++x) {
      if (taken.at<uchar>(y, x) == 0 || outer.at<uchar>(y, x) != 0) continue;
      const float of_face =
          distance(colour_at(image, y, x), *core) / std::max(contrast.at<float>(y, x), kLeastContrast);
      field.at<float>(y, x) = std::min(field.at<float>(y, x), of_face);
    }
  }
  return true;
}

/// A piece in a picture.
struct PieceAt {
  int label;
  cv::Rect box;
};

/// Whether the faces of the pieces with some white along their border are together as white as what may be core: a small piece of a white plate
/// need not show it.  Blank sheets, all white, say nothing of prints beside them.
bool are_white(const cv::Mat& image, const cv::Mat& labels, const std::vector<PieceAt>& pieces) {
  std::array<std::vector<float>, 3> channels;
  for (const PieceAt& piece : pieces) {
    const cv::Mat depth = depth_in(labels(piece.box) == piece.label);
    const auto core = colour_of_core(image(piece.box), rim_of(depth));
    for (std::size_t c = 0; core && c < 3; ++c) channels[c].push_back((*core)[static_cast<int>(c)]);
  }
  if (channels[0].empty()) return false;
  const cv::Vec3f white(median(channels[0]), median(channels[1]), median(channels[2]));
  int all = 0;
  int alike = 0;
  for (const PieceAt& piece : pieces) {
    const cv::Mat mask = labels(piece.box) == piece.label;
    const cv::Mat depth = depth_in(mask);
    const cv::Mat inside = depth > 2.0 * widest_core(mask, depth);
    const cv::Mat same = off_colour(image(piece.box), white) < kSame;
    const double along = share_of(same, rim_of(depth));
    if (along < kLeastRim || along > kMostRim) continue;
    all += cv::countNonZero(inside);
    alike += cv::countNonZero(same & inside);
  }
  return all > 0 && static_cast<double>(alike) > kMostWhite * static_cast<double>(all);
}

}  // namespace

std::vector<cv::Rect> take_off_core(const cv::Mat& image, cv::Mat& field) {
  cv::Mat labels;
  cv::Mat boxes;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(field > 0.5F, labels, boxes, centres, 8, CV_32S);
  std::vector<PieceAt> pieces;
  for (int k = 1; k < count; ++k) {
    if (boxes.at<int>(k, cv::CC_STAT_AREA) < kLeastPixels) continue;
    const cv::Rect box(boxes.at<int>(k, cv::CC_STAT_LEFT) - 1, boxes.at<int>(k, cv::CC_STAT_TOP) - 1,
                       boxes.at<int>(k, cv::CC_STAT_WIDTH) + 2, boxes.at<int>(k, cv::CC_STAT_HEIGHT) + 2);
    pieces.push_back({k, box & cv::Rect({0, 0}, field.size())});
  }
  if (are_white(image, labels, pieces)) return {};
  const cv::Mat before = field.clone();
  std::vector<cv::Rect> taken;
  for (const PieceAt& piece : pieces) {
    if (take_off_one(image(piece.box), labels(piece.box) == piece.label, field(piece.box)))
      taken.push_back(piece.box);
  }
  if (pieces.size() >= kManyPieces &&
      kLeastOfMany * static_cast<double>(pieces.size()) > static_cast<double>(taken.size())) {
    field = before;
    return {};
  }
  return taken;
}

}  // namespace rejoin::outline::detail
