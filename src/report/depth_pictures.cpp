#include "report/depth_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rejoin::report {
namespace {

constexpr Colour kNothing{232, 233, 236};
constexpr int kHead = 64;
constexpr int kMargin = 16;
constexpr int kLegend = 150;

}  // namespace

Image draw_map(const zbuffer::DepthMap& map, const MapPicture& style) {
  const int width = map.width * style.zoom;
  const int height = map.height * style.zoom;
  Image image(width + 2 * kMargin + kLegend, height + kHead + kMargin, kPaper);
  const double centre = style.bar.diverging ? 0.0 : style.bar.low;
  const double range = style.bar.high - centre;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = map.at(x / style.zoom, map.height - 1 - y / style.zoom);
      image.at(kMargin + x, kHead + y) =
          std::isnan(value) ? kNothing : style.bar.colour((value - centre) / range);
    }
  }
  outline(image, {kMargin, kHead, width, height}, {200, 202, 206});
  const TextStyle title{15, kInk, Align::Left, true};
  draw_text(image, kMargin, 28, fitted(style.title, title, image.width - 2 * kMargin), title);
  const TextStyle note{11, kFaint};
  draw_text(image, kMargin, 50, fitted(style.note, note, width), note);
  ColourBar bar = style.bar;
  bar.title = style.unit;
  draw_bar(image, {width + 2 * kMargin, kHead + 24, 22, std::min(height - 48, 420)}, bar, 11);
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
