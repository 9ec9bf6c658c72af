#include "report/colour_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace rejoin::report {
namespace {

/// Even stops, straight in between.  \param share 0 .. 1
Colour along(std::span<const Colour> stops, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  return mix(stops[first], stops[first + 1], at - static_cast<double>(first));
}

constexpr std::array<Colour, 4> kApart{Colour{252, 246, 205}, Colour{127, 190, 214}, Colour{44, 118, 184},
                                       Colour{8, 45, 112}};
constexpr std::array<Colour, 4> kOverlap{Colour{252, 246, 205}, Colour{247, 164, 96}, Colour{208, 51, 43},
                                         Colour{112, 8, 32}};
constexpr std::array<Colour, 9> kEven{Colour{68, 1, 84},    Colour{72, 40, 120},  Colour{62, 74, 137},
                                      Colour{49, 104, 142}, Colour{38, 130, 142}, Colour{31, 158, 137},
                                      Colour{53, 183, 121}, Colour{144, 215, 67}, Colour{253, 231, 37}};

}  // namespace

Colour gap_colour(double share) {
  if (std::isnan(share)) return kNoContact;
  return share < 0 ? along(kOverlap, -share) : along(kApart, share);
}

Colour even_colour(double share) {
  return std::isnan(share) ? kNoContact : along(kEven, share);
}

void draw_bar(Image& image, const Area& area, const ColourBar& bar, double text_height) {
  for (int row = 0; row < area.height; ++row) {
    const double up = 1 - (row + 0.5) / area.height;
    fill(image, {area.x, area.y + row, area.width, 1}, bar.colour(bar.diverging ? 2 * up - 1 : up));
  }
  outline(image, area, kFaint);
  const TextStyle style{text_height, kInk};
  for (const double value : ticks(bar.low, bar.high, 6)) {
    const double y = area.y + (bar.high - value) / (bar.high - bar.low) * area.height;
    draw_line(image, {area.x + area.width, y}, {area.x + area.width + 6, y}, kInk);
    draw_text(image, area.x + area.width + 10, y + text_height / 2, short_number(value), style);
  }
  draw_text(image, area.x, area.y - text_height, bar.title, style);
}

}  // namespace rejoin::report
