#include "report/depth_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rejoin::report {
namespace {

constexpr Colour kNothing{232, 233, 236};
constexpr int kHead = 64;
constexpr int kMargin = 16;
constexpr int kLegend = 130;
constexpr int kPictureSide = 900;  ///< the larger side of an enlarged map, at most
constexpr int kLeastWidth = 560;   ///< room for the labels
constexpr int kLeastHeight = 220;  ///< room for the colour bar

}  // namespace

MapWindow covered_window(const std::vector<const zbuffer::DepthMap*>& maps, int margin) {
  const int width = maps.front()->width;
  const int height = maps.front()->height;
  int left = width, right = -1, low = height, high = -1;
  for (const zbuffer::DepthMap* map : maps) {
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        if (std::isnan(map->at(i, j))) continue;
        left = std::min(left, i);
        right = std::max(right, i);
        low = std::min(low, j);
        high = std::max(high, j);
      }
    }
  }
  if (right < 0) return {0, 0, width, height};
  left = std::max(0, left - margin);
  low = std::max(0, low - margin);
  return {left, low, std::min(width, right + 1 + margin) - left, std::min(height, high + 1 + margin) - low};
}

Image map_pixels(const zbuffer::DepthMap& map, const MapWindow& window, double zoom, const ColourBar& bar) {
  Image image(static_cast<int>(window.width * zoom), static_cast<int>(window.height * zoom), kNothing);
  const double centre = bar.diverging ? 0.0 : bar.low;
  const double range = bar.high - centre;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float value = map.at(window.x + static_cast<int>(x / zoom),
                                 window.y + window.height - 1 - static_cast<int>(y / zoom));
      if (!std::isnan(value)) image.at(x, y) = bar.colour((value - centre) / range);
    }
  }
  return image;
}

Image draw_map(const zbuffer::DepthMap& map, const MapPicture& style) {
  const MapWindow window = style.window.width > 0 ? style.window : MapWindow{0, 0, map.width, map.height};
  const int zoom = std::max(1, std::min(kPictureSide / window.width, kPictureSide / window.height));
  const int width = window.width * zoom;
  const int height = window.height * zoom;
  const int frame = std::max(height, kLeastHeight);
  Image image(std::max(width, kLeastWidth) + 2 * kMargin + kLegend, frame + kHead + kMargin, kPaper);
  paste(image, map_pixels(map, window, zoom, style.bar), kMargin, kHead);
  outline(image, {kMargin, kHead, width, height}, {200, 202, 206});
  const TextStyle title{15, kInk, Align::Left, true};
  draw_text(image, kMargin, 28, fitted(style.title, title, image.width - 2 * kMargin), title);
  const TextStyle note{11, kFaint};
  draw_text(image, kMargin, 50, fitted(style.note, note, image.width - 2 * kMargin), note);
  ColourBar bar = style.bar;
  bar.title = style.unit;
  draw_bar(image, {image.width - kLegend, kHead + 24, 22, std::min(frame - 36, 420)}, bar, 11);
  return image;
}

std::pair<double, double> robust_range(const zbuffer::DepthMap& map, double tail) {
  std::vector<float> values;
  std::copy_if(map.depth.begin(), map.depth.end(), std::back_inserter(values),
               [](float d) { return !std::isnan(d); });
  if (values.empty()) return {0, 1};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(tail), at(1 - tail)};
}

zbuffer::DepthMap heights(const zbuffer::DepthMap& map, double floor) {
  zbuffer::DepthMap result = map;
  for (float& depth : result.depth) depth = static_cast<float>(floor - depth);
  return result;
}

}  // namespace rejoin::report
