#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "core/cyclic.hpp"
#include "core/files.hpp"
#include "core/png_mark.hpp"
#include "core/smooth.hpp"
#include "outline/assembly_pictures.hpp"
#include "outline/signal.hpp"
#include "report/canvas.hpp"
#include "report/outline_pictures.hpp"

namespace rejoin::report {
namespace {

constexpr const char* kMatch = "match.png";
constexpr const char* kJoined = "joined.png";
constexpr int kPanel = 420;
constexpr int kTop = 56;
constexpr int kPlotHeight = 260;
constexpr int kWidth = 3 * kPanel;
constexpr double kInset = 26.0;
constexpr Colour kFillA{226, 205, 178};
constexpr Colour kFillB{178, 203, 226};
constexpr Colour kMark{206, 44, 44};
constexpr Colour kMarkB{40, 92, 178};
constexpr int kSubpixelBits = 4;
/// Samples along the boundary in the plot; curvature is smoothed over kSmooth of them.
constexpr std::size_t kSamples = 400;
constexpr double kSmooth = 3.0;

using Polygon = std::vector<glm::dvec2>;

/// Fits what is shown into a panel.
struct View {
  glm::dvec2 centre{0.0};
  double scale = 1.0;
  glm::dvec2 middle{0.0};
  double y = 1.0;  ///< -1: the pieces' y points up

  glm::dvec2 operator()(const glm::dvec2& p) const {
    return (p - centre) * glm::dvec2(scale, y * scale) + middle;
  }
};

View view_of(const std::vector<Polygon>& shown, bool y_up, int panel) {
  glm::dvec2 low(1e300);
  glm::dvec2 high(-1e300);
  for (const Polygon& polygon : shown) {
    for (const glm::dvec2& p : polygon) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  const double longest = std::max({high.x - low.x, high.y - low.y, 1e-300});
  return {(low + high) / 2.0,
          (kPanel - 2.0 * kInset) / longest,
          {(panel + 0.5) * kPanel, kTop + 0.5 * kPanel},
          y_up ? -1.0 : 1.0};
}

/// A's and B's panels, both at the scale of the larger piece, so that the marked stretches are as long as each other.
std::array<View, 2> views_apart(const outline::Piece& a, const outline::Piece& b) {
  std::array<View, 2> views{view_of({a.outline.points}, a.y_up, 0), view_of({b.outline.points}, b.y_up, 1)};
  views[0].scale = views[1].scale = std::min(views[0].scale, views[1].scale);
  return views;
}

Polygon moved(const Polygon& polygon, const outline::Planar& pose) {
  Polygon result;
  result.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) result.push_back(pose(p));
  return result;
}

void draw_piece(Image& image, const View& view, const outline::Outline& outline, const outline::Planar& pose,
                Colour colour) {
  std::vector<std::vector<cv::Point>> polygons;
  const auto add = [&](const Polygon& polygon) {
    polygons.emplace_back();
    for (const glm::dvec2& p : polygon) {
      const glm::dvec2 at = view(pose(p)) * static_cast<double>(1 << kSubpixelBits);
      polygons.back().emplace_back(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
    }
  };
  add(outline.points);
  for (const Polygon& hole : outline.holes) add(hole);
  cv::Mat canvas(image.height, image.width, CV_8UC3, image.pixels.data());
  cv::fillPoly(canvas, polygons, cv::Scalar(colour.r, colour.g, colour.b), cv::LINE_AA, kSubpixelBits);
  cv::polylines(canvas, polygons, true, cv::Scalar(110, 110, 110), 1, cv::LINE_AA, kSubpixelBits);
}

/// Points along a border from `begin` for `length` (negative: backwards).
Polygon stretch(const Polygon& border, double begin, double length, std::size_t count) {
  const std::vector<double> lengths = outline::arc_lengths(border);
  Polygon points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(outline::point_at(
        border, lengths, begin + length * static_cast<double>(i) / static_cast<double>(count - 1)));
  return points;
}

void draw_curve(Image& image, const View& view, const Polygon& curve, const outline::Planar& pose,
                Colour colour) {
  for (std::size_t i = 0; i + 1 < curve.size(); ++i)
    draw_line(image, view(pose(curve[i])), view(pose(curve[i + 1])), colour, 3);
}

/// The length to go along B from where the boundary begins on it: backwards, or forwards where B lies upside down.
double way_on_b(const outline::JoinCandidate& join) {
  return join.pose.flipped ? join.boundary.length_b() : -join.boundary.length_b();
}

/// Curvature of an open run of points, of the border as it is passed forwards.
std::vector<double> curvature_along(const Polygon& border, double begin, double length) {
  const double step = length / static_cast<double>(kSamples - 1);
  const auto count =
      static_cast<std::size_t>(std::max(8.0, std::round(outline::perimeter(border) / std::abs(step))));
  Polygon even = outline::resample(border, count);
  const std::vector<double> bends = outline::curvature(smooth(even, kSmooth));
  const double own = outline::perimeter(border) / static_cast<double>(count);
  std::vector<double> result;
  result.reserve(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    result.push_back(bends[wrapped(std::llround((begin + step * static_cast<double>(i)) / own), count)]);
  }
  return result;
}

void draw_plot(Image& image, const Area& area, const std::vector<double>& values, double top, Colour colour) {
  const auto at = [&](std::size_t i) {
    const double x = area.x + static_cast<double>(i) * area.width / static_cast<double>(values.size() - 1);
    return glm::dvec2(x, area.y + area.height * (0.5 - 0.5 * std::clamp(values[i] / top, -1.0, 1.0)));
  };
  for (std::size_t i = 0; i + 1 < values.size(); ++i) draw_line(image, at(i), at(i + 1), colour, 1.6);
}

void draw_curvatures(Image& image, const outline::Outline& a, const outline::Outline& b,
                     const outline::JoinCandidate& best) {
  const outline::Boundary& boundary = best.boundary;
  const Area area{60, kTop + kPanel + 44, kWidth - 100, kPlotHeight - 84};
  const std::vector<double> on_a =
      curvature_along(border_of(a, boundary.hole_a), boundary.begin_a, boundary.length_a());
  std::vector<double> on_b = curvature_along(border_of(b, boundary.hole_b), boundary.begin_b, way_on_b(best));
  for (double& bend : on_b) bend = -bend;  // passed backwards, or turned over: true partners are equal
  std::vector<double> sizes;
  sizes.reserve(on_a.size() + on_b.size());
  for (const double v : on_a) sizes.push_back(std::abs(v));
  for (const double v : on_b) sizes.push_back(std::abs(v));
  std::sort(sizes.begin(), sizes.end());
  const double top = std::max(1.3 * sizes[sizes.size() * 98 / 100], 1e-300);
  outline(image, area, kFaint);
  draw_line(image, {area.x, area.y + 0.5 * area.height}, {area.x + area.width, area.y + 0.5 * area.height},
            kFaint);
  draw_plot(image, area, on_a, top, kMark);
  draw_plot(image, area, on_b, top, kMarkB);
  draw_text(image, area.x, area.y - 10, "curvature along the common boundary, A", {13, kMark});
  draw_text(
      image, area.x + 470, area.y - 10,
      best.pose.flipped ? "B, upside down, with its sign changed" : "B, backwards with its sign changed",
      {13, kMarkB});
  draw_text(image, area.x, area.y + area.height + 22, "0", {12});
  draw_text(image, area.x + area.width, area.y + area.height + 22, short_number(boundary.length),
            {12, kInk, Align::Right});
}

void draw_joined(Image& image, const outline::Piece& a, const outline::Piece& b,
                 const outline::JoinCandidate& best, const std::string& verdict) {
  const View joined = view_of({a.outline.points, moved(b.outline.points, best.pose)}, a.y_up && b.y_up, 2);
  draw_piece(image, joined, a.outline, {}, kFillA);
  draw_piece(image, joined, b.outline, best.pose, kFillB);
  const outline::Boundary& boundary = best.boundary;
  const Polygon on_a =
      stretch(border_of(a.outline, boundary.hole_a), boundary.begin_a, boundary.length_a(), kSamples);
  const Polygon on_b =
      stretch(border_of(b.outline, boundary.hole_b), boundary.begin_b, way_on_b(best), kSamples);
  const auto [view_a, view_b] = views_apart(a, b);
  draw_curve(image, view_a, on_a, {}, kMark);
  draw_curve(image, view_b, on_b, {}, kMarkB);
  draw_curve(image, joined, on_a, {}, kMark);
  draw_text(image, 2 * kPanel + kInset, 34, fmt::format("{}, score {:.3f}: best pose", verdict, best.score),
            {15, kInk, Align::Left, true});
}

}  // namespace

std::vector<std::filesystem::path> write_outline_match_pictures(const std::filesystem::path& folder,
                                                                const outline::Piece& a,
                                                                const outline::Piece& b,
                                                                const outline::PairResult& result,
                                                                const std::string& verdict) {
  Image image(kWidth, kTop + kPanel + kPlotHeight, kPaper);
  const TextStyle title{15, kInk, Align::Left, true};
  draw_text(image, kInset, 34, fitted("A: " + a.name, title, kPanel - 2 * kInset), title);
  draw_text(image, kPanel + kInset, 34, fitted("B: " + b.name, title, kPanel - 2 * kInset), title);
  const auto [view_a, view_b] = views_apart(a, b);
  draw_piece(image, view_a, a.outline, {}, kFillA);
  draw_piece(image, view_b, b.outline, {}, kFillB);
  if (!result.candidates.empty()) {
    const outline::JoinCandidate& best = result.candidates.front();
    draw_joined(image, a, b, best, verdict);
    draw_curvatures(image, a.outline, b.outline, best);
    const std::vector<std::uint8_t> bytes = outline::assembled_png({a, b}, {{}, best.pose});
    rejoin::write_file(folder / kJoined,
                       marked_png({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  }
  write_png(folder / kMatch, image);
  std::vector<std::filesystem::path> files{folder / kMatch};
  if (!result.candidates.empty()) files.push_back(folder / kJoined);
  return files;
}

std::vector<std::filesystem::path> outline_match_pictures(const std::filesystem::path& folder) {
  return {folder / kMatch, folder / kJoined};
}

}  // namespace rejoin::report
