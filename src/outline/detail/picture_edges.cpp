#include "outline/detail/picture_edges.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "core/median.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr int kWidest = 60;            // pixels
constexpr double kWidestShare = 0.05;  // of the picture
constexpr int kSoft = 2;               // lines behind it over which its end may be blurred
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

/// How many lines along an edge are of another colour than those behind; 0: none, or they go on too far, or the colour changes slowly.
int other_lines(const cv::Mat& image, Edge edge) {
  const int most = std::min(kWidest, static_cast<int>(kWidestShare * std::min(image.rows, image.cols)));
  const cv::Mat inside = line_at(image, edge, 2 * most);
  const cv::Vec3f background = middle_colour(inside);
  if (share_of_others(inside, background) > kPieces) return 0;
  int lines = 0;
  while (lines < most && is_other(line_at(image, edge, lines), background)) ++lines;
  if (lines == 0 || lines == most) return 0;
  // A colour that changes slowly is light.
  const cv::Vec3f behind = middle_colour(line_at(image, edge, lines + kSoft));
  return is_other(line_at(image, edge, std::max(0, lines - 1 - kSoft)), behind) ? lines + kSoft : 0;
}

}  // namespace

std::string paint_over_edges(cv::Mat& image) {
  constexpr std::array<std::pair<Edge, const char*>, 4> kEdges{
      {{Edge::Upper, "upper"}, {Edge::Right, "right"}, {Edge::Lower, "lower"}, {Edge::Left, "left"}}};
  std::string told;
  for (const auto& [edge, name] : kEdges) {
    const int lines = other_lines(image, edge);
    if (lines == 0) continue;
    const cv::Mat behind = line_at(image, edge, lines);
    for (int k = 0; k < lines; ++k) behind.copyTo(line_at(image, edge, k));
    told += fmt::format("{}{} ({} pixels)", told.empty() ? "" : ", ", name, lines);
  }
  if (told.empty()) return {};
  return fmt::format("lines of another colour along the picture's edges are left out: {}", told);
}

}  // namespace rejoin::outline::detail
