/// Depth maps and their differences as pictures.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/colour_scale.hpp"
#include "zbuffer/depth_map.hpp"

namespace rejoin::report {

/// The part of a map that is shown, map pixels.
struct MapWindow {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// The box of all covered pixels of the maps (of equal shape) with `margin` pixels around it; the whole map
/// if nothing is covered.
MapWindow covered_window(const std::vector<const zbuffer::DepthMap*>& maps, int margin);

/// The pixels of a map in colours, v upwards, background pale.
/// \param zoom  picture pixels a map pixel, >= 1
Image map_pixels(const zbuffer::DepthMap& map, const MapWindow& window, double zoom, const ColourBar& bar);

/// How a map is coloured and labelled.
struct MapPicture {
  std::string title;
  std::string note;  ///< second line
  std::string unit;  ///< above the colour bar
  ColourBar bar;     ///< bar.title is taken from `unit`
  MapWindow window;  ///< width 0: the whole map
};

/// The map, enlarged to about 900 pixels, with v upwards, a colour bar and the labels.  Background stays
/// pale.
Image draw_map(const zbuffer::DepthMap& map, const MapPicture& style);

/// Smallest and largest depth but for `tail` of the covered pixels at each end; (0, 1) if nothing is covered.
std::pair<double, double> robust_range(const zbuffer::DepthMap& map, double tail);

/// The map turned into heights above `floor`: bright is near.
zbuffer::DepthMap heights(const zbuffer::DepthMap& map, double floor);

}  // namespace rejoin::report
