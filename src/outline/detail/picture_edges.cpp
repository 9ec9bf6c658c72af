#include "outline/detail/picture_edges.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "core/median.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kWidest = 60;            // pixels
constexpr double kWidestShare = 0.05;  // of the picture
constexpr int kBlurred = 2;            // lines behind it over which its end may be blurred
constexpr float kOther = 0.06F;        // colour, 0..1 a channel, root of the squares' sum
constexpr double kPieces = 0.4;        // of a line farther inside: more may be pieces than background
constexpr double kWhole = 0.9;         // of a line's pixels that have another colour than what lies behind

enum class Edge { Upper, Right, Lower, Left };

/// The k-th line from an edge, a view.
cv::Mat line_at(const cv::Mat& image, Edge edge, int k) {
  switch (edge) {
    case Edge::Upper:
      return image.row(k);
    case Edge::Right:
      return image.col(image.cols - 1 - k);
    case Edge::Lower:
      return image.row(image.rows - 1 - k);
    case Edge::Left:
      break;
  }
  return image.col(k);
}

/// Medians of a line's channels.
cv::Vec3f middle_colour(const cv::Mat& line) {
  cv::Vec3f middle;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float> values;
    values.reserve(line.total());
    for (auto pixel = line.begin<cv::Vec3f>(); pixel != line.end<cv::Vec3f>(); ++pixel)
      values.push_back((*pixel)[channel]);
    middle[channel] = median(values);
  }
  return middle;
}

/// The share of a line's pixels that have another colour.
double share_of_others(const cv::Mat& line, const cv::Vec3f& colour) {
  const auto other = std::count_if(
      line.begin<cv::Vec3f>(), line.end<cv::Vec3f>(),
      [&](const cv::Vec3f& pixel) { return cv::norm(pixel - colour) > static_cast<double>(kOther); });
  return static_cast<double>(other) / static_cast<double>(line.total());
}

bool is_other(const cv::Mat& line, const cv::Vec3f& colour) {
  return share_of_others(line, colour) > kWhole;
}

/// Lines along an edge of another colour than what lies behind.
struct EdgeBand {
  Edge edge;
  const char* name;
  int lines = 0;  ///< 0: there are none, or they go on too far, or the colour changes slowly
  cv::Vec3f behind;
};

EdgeBand band_at(const cv::Mat& image, Edge edge, const char* name) {
  EdgeBand band{edge, name, 0, {}};
  const int most = std::min(kWidest, static_cast<int>(kWidestShare * std::min(image.rows, image.cols)));
  const cv::Mat inside = line_at(image, edge, 2 * most);
  band.behind = middle_colour(inside);
  if (share_of_others(inside, band.behind) > kPieces) return band;
  int lines = 0;
  while (lines < most && is_other(line_at(image, edge, lines), band.behind)) ++lines;
  if (lines == 0 || lines == most) return band;
  // A colour that changes slowly is light.
  const cv::Vec3f next = middle_colour(line_at(image, edge, lines + kBlurred));
  if (is_other(line_at(image, edge, std::max(0, lines - 1 - kBlurred)), next)) band.lines = lines + kBlurred;
  return band;
}

/// Whether what lies behind all bands is what the other edges have: else it is the pieces, and the bands are the background beside them.
bool lie_before_background(const cv::Mat& image, const std::vector<EdgeBand>& bands) {
  const auto is_band = [](const EdgeBand& band) { return band.lines > 0; };
  if (std::ranges::all_of(bands, is_band)) return false;
  for (const EdgeBand& free : bands) {
    if (is_band(free)) continue;
    const cv::Vec3f outermost = middle_colour(line_at(image, free.edge, 0));
    for (const EdgeBand& band : bands)
      if (is_band(band) && cv::norm(outermost - band.behind) > static_cast<double>(kOther)) return false;
  }
  return true;
}

}  // namespace

std::string paint_over_edges(cv::Mat& image) {
  const std::vector<EdgeBand> bands{band_at(image, Edge::Upper, "upper"),
                                    band_at(image, Edge::Right, "right"),
                                    band_at(image, Edge::Lower, "lower"), band_at(image, Edge::Left, "left")};
  if (!lie_before_background(image, bands)) return {};
  std::string told;
  for (const EdgeBand& band : bands) {
    if (band.lines == 0) continue;
    const cv::Mat behind = line_at(image, band.edge, band.lines);
    for (int k = 0; k < band.lines; ++k) behind.copyTo(line_at(image, band.edge, k));
    told += fmt::format("{}{} ({} pixels)", told.empty() ? "" : ", ", band.name, band.lines);
  }
  if (told.empty()) return {};
  return fmt::format("lines of another colour along the picture's edges are left out: {}", told);
}

}  // namespace rejoin::outline::detail
