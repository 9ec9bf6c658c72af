#include "outline/detail/repeats.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/words.hpp"
#include "outline/detail/drawing.hpp"

namespace rejoin::outline::detail {
namespace {

/// Whether two pictures' pieces have the same outline and the same colours along it, but for what saving them in another format
/// changes: noise moves the points along the border too, and opens and closes holes in print.
bool same_border_pixels(const Outline& a, const Outline& b) {
  constexpr std::size_t kPlaces = 64;
  constexpr double kApart = 0.75;   // pixels, on average; points of a contour are up to one apart
  constexpr double kShade = 0.015;  // of the mean colour, in which noise cancels
  constexpr double kArea = 0.01;    // of the larger
  const std::size_t count = a.points.size();
  if (a.colour.size() != count || b.colour.size() != b.points.size()) return false;
  const double area_a = signed_area(a.points);
  const double area_b = signed_area(b.points);
  if (std::abs(area_a - area_b) > kArea * std::max(area_a, area_b)) return false;
  double apart = 0.0;
  glm::dvec3 shade(0.0);
  for (std::size_t k = 0; k < kPlaces && apart < kApart; ++k) {
    const std::size_t i = k * count / kPlaces;
    const auto off = [&](const glm::dvec2& p) { return glm::distance(p, a.points[i]); };
    const auto nearest = std::ranges::min_element(b.points, {}, off);
    apart += off(*nearest) / kPlaces;
    shade += (a.colour[i] - b.colour[static_cast<std::size_t>(nearest - b.points.begin())]) /
             static_cast<double>(kPlaces);
  }
  return apart < kApart && glm::length(shade) < kShade;
}

bool same_outline(const Outline& a, const Outline& b) {
  return (a.points == b.points && a.holes == b.holes && a.colour == b.colour) || same_border_pixels(a, b);
}

/// What pictures show, in blocks of pixels, as compression leaves a block's mean.  Kept, as all cards of one size are compared.
class Pictures {
 public:
  struct Blocks {
    cv::Mat means;          ///< CV_8UC3
    int side = kLeastSide;  ///< pixels
  };

  /// \throws IoError, InputError  it cannot be read again
  const Blocks& of(const Piece& piece) {
    const auto [known, fresh] = pictures_.try_emplace(piece.path);
    if (!fresh) return known->second;
    const cv::Mat colours = colours_on_white(piece);
    Blocks& blocks = known->second;
    blocks.side = std::max(kLeastSide, std::max(colours.cols, colours.rows) / kMostBlocks);
    cv::Mat means;
    cv::resize(colours, means, {colours.cols / blocks.side + 1, colours.rows / blocks.side + 1}, 0.0, 0.0,
               cv::INTER_AREA);
    means.convertTo(blocks.means, CV_8UC3, 255.0);
    return blocks;
  }

 private:
  static constexpr int kLeastSide = 4;
  static constexpr int kMostBlocks = 500;  // along a side

  std::map<std::string, Blocks> pictures_;
};

/// The blocks that lie inside a border.
cv::Mat inside(const std::vector<glm::dvec2>& border, const Pictures::Blocks& blocks) {
  std::vector<cv::Point> corners;
  corners.reserve(border.size());
  for (const glm::dvec2& p : border)
    corners.emplace_back(static_cast<int>(p.x) / blocks.side, static_cast<int>(p.y) / blocks.side);
  cv::Mat mask = cv::Mat::zeros(blocks.means.size(), CV_8U);
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{corners}, cv::Scalar(255));
  cv::erode(mask, mask, cv::Mat());
  return mask;
}

/// Whether what is seen inside two pieces of one outline is the same, but for what compression does to it.
bool same_inside(const Piece& a, const Piece& b, Pictures& pictures) {
  constexpr double kMost = 0.12 * 255;  // between two blocks; a letter changes some by more
  const Pictures::Blocks& blocks_a = pictures.of(a);
  const Pictures::Blocks& blocks_b = pictures.of(b);
  if (blocks_a.means.size() != blocks_b.means.size()) return false;
  cv::Mat difference;
  cv::absdiff(blocks_a.means, blocks_b.means, difference);
  return cv::norm(difference, cv::NORM_INF, inside(a.outline.points, blocks_a)) <= kMost;
}

bool same(const Piece& a, const Piece& b, Pictures& pictures) {
  if (!same_outline(a.outline, b.outline)) return false;
  if (!is_picture(a) || !is_picture(b)) return true;
  try {
    return same_inside(a, b, pictures);
  } catch (const Error&) {  // gone since it was read: both are kept
    return false;
  }
}

}  // namespace

void take_out_repeats(PieceSet& set) {
  Pictures pictures;
  std::vector<Piece> kept;
  kept.reserve(set.pieces.size());
  for (Piece& piece : set.pieces) {
    const auto first = std::find_if(kept.begin(), kept.end(),
                                    [&](const Piece& other) { return same(other, piece, pictures); });
    if (first == kept.end()) {
      kept.push_back(std::move(piece));
      continue;
    }
    const bool better = stands_for_both(piece.name, first->name);
    const std::string stays = better ? piece.name : first->name;
    const std::string goes = better ? first->name : piece.name;
    const char* what = is_picture(piece) ? "picture" : "outline";
    set.repeated.push_back(
        {goes, fmt::format("{} and {} are the same {}; {} is left out", stays, goes, what, goes)});
    if (!better) continue;
    kept.erase(first);
    kept.push_back(std::move(piece));
  }
  set.pieces = std::move(kept);
}

}  // namespace rejoin::outline::detail
