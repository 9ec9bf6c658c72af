#include "outline/pieces_picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "outline/detail/drawing.hpp"

namespace rejoin::outline {
namespace {

constexpr int kTile = 260;        // pixels, name included
constexpr int kName = 22;         // of these for the name
constexpr int kGap = 8;           // around what a cell shows
constexpr double kAround = 0.08;  // of a piece's extent, shown around it
constexpr int kShift = 8;         // binary places of drawn points
constexpr std::size_t kMostColumns = 20;

const cv::Scalar kRed(40, 40, 220);

/// What a cell shows of the piece's own coordinates.
struct Window {
  glm::dvec2 low{0.0};
  glm::dvec2 high{0.0};
  double scale = 1.0;  ///< pixels of the sheet for a unit
  bool y_up = false;

  explicit Window(const Piece& piece) : y_up(piece.y_up) {
    low = high = piece.outline.points[0];
    for (const glm::dvec2& p : piece.outline.points) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    const double around = kAround * std::max(high.x - low.x, high.y - low.y);
    low -= around;
    high += around;
    const glm::dvec2 extent = high - low;
    scale = std::min((kTile - 2.0 * kGap) / extent.x, (kTile - kName - 2.0 * kGap) / extent.y);
  }

  /// The place in the window, pixels.
  glm::dvec2 operator()(const glm::dvec2& p) const {
    return glm::dvec2(p.x - low.x, y_up ? high.y - p.y : p.y - low.y) * scale;
  }

  cv::Size size() const {
    return {std::max(1, static_cast<int>((high.x - low.x) * scale)),
            std::max(1, static_cast<int>((high.y - low.y) * scale))};
  }
};

cv::Mat shown(const Piece& piece, const Window& window, detail::LastPicture& source) {
  if (!detail::is_picture(piece)) return {window.size(), CV_8UC3, cv::Scalar(235, 235, 235)};
  const cv::Matx23d motion(window.scale, 0.0, -window.low.x * window.scale, 0.0, window.scale,
                           -window.low.y * window.scale);
  return detail::resampled(source.on_white(piece), motion, window.size(), cv::BORDER_CONSTANT);
}

void draw_border(cv::Mat& image, const std::vector<glm::dvec2>& polygon, const Window& window) {
  std::vector<cv::Point> points;
  points.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) {
    const glm::dvec2 at = window(p) * static_cast<double>(1 << kShift);
    points.emplace_back(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
  }
  cv::polylines(image, points, true, kRed, 1, cv::LINE_AA, kShift);
}

}  // namespace

void write_pieces_picture(const std::filesystem::path& path, const std::vector<Piece>& pieces) {
  const std::size_t count = std::min(pieces.size(), kMostOnASheet);
  const std::size_t columns = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(std::sqrt(1.5 * static_cast<double>(count)))), 1, kMostColumns);
  const std::size_t rows = (count + columns - 1) / columns;
  cv::Mat sheet(static_cast<int>(rows) * kTile, static_cast<int>(columns) * kTile, CV_8UC3,
                cv::Scalar(255, 255, 255));
  detail::LastPicture source;
  for (std::size_t k = 0; k < count; ++k) {
    const Piece& piece = pieces[k];
    const cv::Point corner(static_cast<int>(k % columns) * kTile, static_cast<int>(k / columns) * kTile);
    const Window window(piece);
    cv::Mat part = shown(piece, window, source);
    draw_border(part, piece.outline.points, window);
    for (const auto& hole : piece.outline.holes) draw_border(part, hole, window);
    part.copyTo(sheet(cv::Rect(corner + cv::Point((kTile - part.cols) / 2, kGap), part.size())));
    cv::putText(sheet, std::to_string(k) + "  " + detail::short_name(piece.name),
                corner + cv::Point(kGap, kTile - kName / 2 + 3), cv::FONT_HERSHEY_SIMPLEX, 0.4,
                cv::Scalar(60, 60, 60), 1, cv::LINE_AA);
  }
  detail::write_png(path, sheet);
}

}  // namespace rejoin::outline
