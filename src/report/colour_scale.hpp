/// From numbers to colours, with the bar that explains them.
#pragma once

#include <string>

#include "report/canvas.hpp"

namespace rejoin::report {

inline constexpr Colour kNoContact{176, 178, 182};

/// |gap| of the strongest colours, in medians of |gap|: nearly all of a joint is paler, and chips, however deep, leave the scale alone.
inline constexpr double kMedianGaps = 4.0;

/// Gap colours, readable by the colour-blind: -1 = deep red (the surfaces overlap), 0 = pale yellow (they
/// touch), 1 = deep blue (they stand apart).  NaN gives grey: no contact.
Colour gap_colour(double share);

/// Dark blue through green to yellow with even steps in lightness (viridis).  share 0 .. 1; NaN gives grey.
Colour even_colour(double share);

/// A vertical colour bar with round numbers beside it.
struct ColourBar {
  Colour (*colour)(double share);  ///< gap_colour or even_colour
  double low = 0;                  ///< value at the bar's lower end
  double high = 1;
  bool diverging = false;  ///< shares run -1 .. 1 instead of 0 .. 1
  std::string title;       ///< above the bar, with the unit
};

/// \param area  of the bar itself; the numbers go to its right, the title above
void draw_bar(Image& image, const Area& area, const ColourBar& bar, double text_height);

}  // namespace rejoin::report
