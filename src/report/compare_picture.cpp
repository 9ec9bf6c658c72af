#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/words.hpp"
#include "report/compare_report.hpp"
#include "report/depth_pictures.hpp"

namespace rejoin::report {
namespace {

using match::Comparison;
using match::GridPose;
using zbuffer::DepthMap;
using zbuffer::PairScore;

constexpr int kMargin = 20;
constexpr int kPanel = 400;   ///< side of a map panel
constexpr int kLegend = 104;  ///< room for a colour bar and its numbers
constexpr int kRowHead = 64;
constexpr int kRow = kRowHead + kPanel + 24;
constexpr int kTop = 78;
constexpr int kChart = 460;
constexpr int kWidth = 2 * kMargin + 3 * (kPanel + kLegend) + kChart + 60;
constexpr int kHeight = kTop + 2 * kRow + kMargin;

/// Largest |value| but for `tail` of them, round; `least` if that is smaller.
double robust_size(const std::vector<const DepthMap*>& maps, double tail, double least) {
  std::vector<float> sizes;
  for (const DepthMap* map : maps) {
    for (const float value : map->depth) {
      if (!std::isnan(value)) sizes.push_back(std::abs(value));
    }
  }
  if (sizes.empty()) return round_up(least);
  const auto at =
      sizes.begin() + static_cast<std::ptrdiff_t>((1 - tail) * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), at, sizes.end());
  return round_up(std::max(least, static_cast<double>(*at)));
}

void draw_panel(Image& sheet, int x, int y, const std::string& caption, const DepthMap& map,
                const MapWindow& window, double size, bool with_bar) {
  const ColourBar bar{gap_colour, -size, size, true, ""};
  const double zoom = std::max(1.0, static_cast<double>(kPanel) / std::max(window.width, window.height));
  const Image pixels = map_pixels(map, window, zoom, bar);
  draw_text(sheet, x, y - 8, caption, {12, kInk});
  fill(sheet, {x, y, kPanel, kPanel}, {232, 233, 236});
  paste(sheet, pixels, x + (kPanel - pixels.width) / 2, y + (kPanel - pixels.height) / 2);
  outline(sheet, {x, y, kPanel, kPanel}, {200, 202, 206});
  if (with_bar) draw_bar(sheet, {x + kPanel + 10, y + 10, 18, kPanel - 20}, bar, 11);
}

void draw_row(Image& sheet, int y, const std::string& title, const match::RenderingDifference& difference,
              const MapWindow& window, double view_side) {
  draw_text(sheet, kMargin, y + 16, title, {14, kInk, Align::Left, true});
  const int top = y + kRowHead;
  const double depth = robust_size({&difference.depth_a, &difference.depth_b}, 0.01, 1e-6 * view_side);
  const double slope = robust_size({&difference.error}, 0.02, 1e-4);
  int x = kMargin;
  draw_panel(sheet, x, top, "A: depth [mesh units]", difference.depth_a, window, depth, true);
  x += kPanel + kLegend;
  draw_panel(sheet, x, top, "B, mirrored: depth [mesh units]", zbuffer::mirrored(difference.depth_b), window,
             depth, true);
  x += kPanel + kLegend;
  draw_panel(sheet, x, top, "slope difference of the joint [slope]", difference.error, window, slope, true);
}

/// Errors of two columns over the grid as points, with the line on which they would be equal.
void draw_scatter(Image& sheet, const Area& area, const Comparison& comparison, PairScore GridPose::*across,
                  PairScore GridPose::*up, const std::string& title_x, const std::string& title_y) {
  const auto slope = [&](const PairScore& score) {
    return static_cast<double>(score.error) * comparison.resolution;
  };
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const GridPose& pose : comparison.grid) {
    for (const double value : {slope(pose.*across), slope(pose.*up)}) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  outline(sheet, area, {200, 202, 206});
  if (!(high > 0)) {
    draw_text(sheet, area.x + area.width / 2.0, area.y + area.height / 2.0, "no overlap",
              {12, kFaint, Align::Middle});
    return;
  }
  const double room = std::max(0.05 * (high - low), 1e-3 * high);
  low -= room;
  high += room;
  const auto x_of = [&](double value) { return area.x + (value - low) / (high - low) * area.width; };
  const auto y_of = [&](double value) {
    return area.y + area.height - (value - low) / (high - low) * area.height;
  };
  for (const double value : ticks(low, high, 5)) {
    draw_line(sheet, {x_of(value), area.y + area.height}, {x_of(value), area.y + area.height + 5}, kInk);
    draw_text(sheet, x_of(value), area.y + area.height + 20, short_number(value), {11, kInk, Align::Middle});
    draw_line(sheet, {area.x - 5, y_of(value)}, {area.x, y_of(value)}, kInk);
    draw_text(sheet, area.x - 8, y_of(value) + 5, short_number(value), {11, kInk, Align::Right});
  }
  draw_line(sheet, {x_of(low), y_of(low)}, {x_of(high), y_of(high)}, {170, 172, 178});
  const auto mark = [&](const GridPose& pose, Colour colour, int size) {
    const double x = x_of(slope(pose.*across));
    const double y = y_of(slope(pose.*up));
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    fill(sheet, {static_cast<int>(x) - size / 2, static_cast<int>(y) - size / 2, size, size}, colour);
  };
  for (const GridPose& pose : comparison.grid) mark(pose, {44, 118, 184}, 4);
  mark(comparison.pose, {208, 51, 43}, 9);
  draw_text(sheet, area.x + area.width, area.y + area.height + 42, title_x, {11, kInk, Align::Right});
  draw_text(sheet, area.x, area.y - 8, title_y, {11, kInk});
}

}  // namespace

Image draw_comparison(const Comparison& comparison, const std::string& name_a, const std::string& name_b) {
  Image sheet(kWidth, kHeight, kPaper);
  const TextStyle title{18, kInk, Align::Left, true};
  draw_text(sheet, kMargin, 36,
            fitted("Matching error of " + name_a + " and " + name_b + ": drawn against ray cast", title,
                   kWidth - 2 * kMargin),
            title);
  const auto slope = [&](const PairScore& score) {
    return static_cast<double>(score.error) * comparison.resolution;
  };
  draw_text(sheet, kMargin, 60,
            fmt::format("slope difference of the whole fragments at the pose (red): drawn {}, ray cast {}, "
                        "ray cast at full detail {};  "
                        "{} x {} pixels; {}; {}",
                        short_number(slope(comparison.pose.drawn)), short_number(slope(comparison.pose.cast)),
                        short_number(slope(comparison.pose.cast_full)), comparison.resolution,
                        comparison.resolution, comparison.renderer, comparison.caster),
            {12, kFaint});
  const DepthMap mirrored_b = zbuffer::mirrored(comparison.detail.depth_b);
  const MapWindow window = covered_window({&comparison.detail.depth_a, &mirrored_b}, 2);
  draw_row(sheet, kTop, "Drawing: " + comparison.drawing.first + "  -  " + comparison.drawing.second,
           comparison.drawing, window, comparison.view.view_side);
  draw_row(sheet, kTop + kRow,
           "Level of detail: " + comparison.detail.first + "  -  " + comparison.detail.second,
           comparison.detail, window, comparison.view.view_side);
  const int left = kMargin + 3 * (kPanel + kLegend) + 60;
  const int side = kPanel - 30;
  draw_scatter(sheet, {left, kTop + kRowHead, side, side}, comparison, &GridPose::cast, &GridPose::drawn,
               "ray cast, same meshes",
               "drawn: slope difference at " + counted(comparison.grid.size(), "pose"));
  draw_scatter(sheet, {left, kTop + kRow + kRowHead, side, side}, comparison, &GridPose::cast_full,
               &GridPose::cast, "ray cast, full meshes", "ray cast, coarse meshes");
  return sheet;
}

}  // namespace rejoin::report
