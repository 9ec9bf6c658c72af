/// Drawing of labels, lines and panels into a picture.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/image.hpp"

namespace rejoin::report {

inline constexpr Colour kInk{30, 32, 36};
inline constexpr Colour kFaint{110, 114, 120};
inline constexpr Colour kPaper{250, 250, 250};

/// Pixels, from the upper left corner.
struct Area {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

enum class Align { Left, Middle, Right };

struct TextStyle {
  double height = 16;  ///< of a capital letter, pixels
  Colour colour = kInk;
  Align align = Align::Left;
  bool bold = false;
};

/// Writes one line with its capitals standing on y.  Only ASCII can be shown (OpenCV's stroke font needs no font file):
/// Latin letters lose their accents, each other character becomes a '?'.
void draw_text(Image& image, double x, double y, const std::string& text, const TextStyle& style);

/// Width that draw_text() needs, pixels.
double text_width(const std::string& text, const TextStyle& style);

/// The text cut in its middle by "..." to fit the width.
std::string fitted(const std::string& text, const TextStyle& style, double width);

/// Anti-aliased line; positions are pixel coordinates.
void draw_line(Image& image, glm::dvec2 from, glm::dvec2 to, Colour colour, double thickness = 1);

void fill(Image& image, const Area& area, Colour colour);
void outline(Image& image, const Area& area, Colour colour);

/// Copies `part` with its upper left corner to (x, y); what lies outside is left away.
void paste(Image& image, const Image& part, int x, int y);

/// A number with three significant digits, never in a form that needs a superscript.
std::string short_number(double value);

/// Round values (1, 2 or 5 times a power of ten apart) from low to high, about `count` of them.
/// \pre low < high, both finite
std::vector<double> ticks(double low, double high, int count);

/// The least 1, 2 or 5 times a power of ten that is not below value.  \pre value > 0
double round_up(double value);

}  // namespace rejoin::report
