#include "report/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/ascii.hpp"

namespace rejoin::report {
namespace {

constexpr int kFine = 4;  ///< text is drawn this much larger and then averaged: smooth at any size
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapital = 21.0;  ///< height of its capitals at scale 1, pixels
constexpr int kSubpixelBits = 4;

double scale_of(const TextStyle& style) {
  return style.height * kFine / kCapital;
}

int stroke_of(const TextStyle& style) {
  const double share = style.bold ? 0.16 : 0.105;  // of the capital's height
  return std::max(1, static_cast<int>(std::lround(style.height * kFine * share)));
}

/// Coverage 0 .. 255 of a line of text, with `base` rows above the baseline.
struct Stencil {
  cv::Mat coverage;
  int base = 0;
};

Stencil stencil_of(const std::string& text, const TextStyle& style) {
  int below = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale_of(style), stroke_of(style), &below);
  const int margin = 2 * kFine + stroke_of(style);
  const int base = (size.height + margin + kFine - 1) / kFine;
  const int rows = base + (below + margin) / kFine + 1;
  const int columns = (size.width + 2 * margin) / kFine + 1;
  cv::Mat fine(rows * kFine, columns * kFine, CV_8UC1, cv::Scalar(0));
  cv::putText(fine, text, {margin, base * kFine}, kFont, scale_of(style), 255, stroke_of(style), cv::LINE_AA);
  Stencil result;
  result.base = base;
  cv::resize(fine, result.coverage, {columns, rows}, 0, 0, cv::INTER_AREA);
  return result;
}

cv::Mat view_of(Image& image) {
  return {image.height, image.width, CV_8UC3, image.pixels.data()};
}

cv::Point subpixel(const glm::dvec2& p) {
  constexpr double kScale = 1 << kSubpixelBits;
  return {static_cast<int>(std::lround((p.x - 0.5) * kScale)),
          static_cast<int>(std::lround((p.y - 0.5) * kScale))};
}

cv::Scalar scalar(Colour c) {
  return {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
}

}  // namespace

double text_width(const std::string& text, const TextStyle& style) {
  int below = 0;
  return static_cast<double>(
             cv::getTextSize(ascii(text), kFont, scale_of(style), stroke_of(style), &below).width) /
         kFine;
}

std::string fitted(const std::string& text, const TextStyle& style, double width) {
  std::string plain = ascii(text);
  if (text_width(plain, style) <= width) return plain;
  for (std::size_t keep = plain.size(); keep > 2; --keep) {
    const std::size_t head = keep / 2;
    std::string shorter = plain.substr(0, head) + "..." + plain.substr(plain.size() - (keep - head));
    if (text_width(shorter, style) <= width) return shorter;
  }
  return "...";
}

void draw_text(Image& image, double x, double y, const std::string& text, const TextStyle& style) {
  const std::string plain = ascii(text);
  if (plain.empty()) return;
  const double width = text_width(plain, style);
  if (style.align == Align::Middle) x -= width / 2;
  if (style.align == Align::Right) x -= width;
  const Stencil stencil = stencil_of(plain, style);
  const int left = static_cast<int>(std::lround(x)) - (2 * kFine + stroke_of(style)) / kFine;
  const int top = static_cast<int>(std::lround(y)) - stencil.base;
  for (int j = 0; j < stencil.coverage.rows; ++j) {
    for (int i = 0; i < stencil.coverage.cols; ++i) {
      const int px = left + i;
      const int py = top + j;
      if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
      image.at(px, py) = mix(image.at(px, py), style.colour, stencil.coverage.at<std::uint8_t>(j, i) / 255.0);
    }
  }
}

void draw_line(Image& image, glm::dvec2 from, glm::dvec2 to, Colour colour, double thickness) {
  cv::Mat view = view_of(image);
  cv::line(view, subpixel(from), subpixel(to), scalar(colour),
           std::max(1, static_cast<int>(std::lround(thickness))), cv::LINE_AA, kSubpixelBits);
}

void fill(Image& image, const Area& area, Colour colour) {
  for (int y = std::max(0, area.y); y < std::min(image.height, area.y + area.height); ++y) {
    for (int x = std::max(0, area.x); x < std::min(image.width, area.x + area.width); ++x)
      image.at(x, y) = colour;
  }
}

void outline(Image& image, const Area& area, Colour colour) {
  fill(image, {area.x, area.y, area.width, 1}, colour);
  fill(image, {area.x, area.y + area.height - 1, area.width, 1}, colour);
  fill(image, {area.x, area.y, 1, area.height}, colour);
  fill(image, {area.x + area.width - 1, area.y, 1, area.height}, colour);
}

void paste(Image& image, const Image& part, int x, int y) {
  for (int j = std::max(0, -y); j < std::min(part.height, image.height - y); ++j) {
    for (int i = std::max(0, -x); i < std::min(part.width, image.width - x); ++i)
      image.at(x + i, y + j) = part.at(i, j);
  }
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size >= 1e6 || size < 1e-4) return fmt::format("{:.2e}", value);
  const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

std::vector<double> ticks(double low, double high, int count) {
  const double step = round_up((high - low) / std::max(1, count));
  std::vector<double> result;
  const auto first = static_cast<long>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(high / step + 1e-9));
  for (long k = first; k <= last; ++k) result.push_back(static_cast<double>(k) * step);
  return result;
}

}  // namespace rejoin::report
