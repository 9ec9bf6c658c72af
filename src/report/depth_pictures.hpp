/// Depth maps and their differences as pictures.
#pragma once

#include <string>

#include "report/colour_scale.hpp"
#include "zbuffer/depth_map.hpp"

namespace rejoin::report {

/// How a map is coloured and labelled.
struct MapPicture {
  std::string title;
  std::string note;  ///< second line
  std::string unit;  ///< above the colour bar
  ColourBar bar;     ///< bar.title is taken from `unit`
  int zoom = 3;      ///< picture pixels a map pixel
};

/// The map with v upwards, a colour bar and the labels.  Background stays pale.
Image draw_map(const zbuffer::DepthMap& map, const MapPicture& style);

/// Smallest and largest depth but for `tail` of the covered pixels at each end; (0, 1) if nothing is covered.
std::pair<double, double> robust_range(const zbuffer::DepthMap& map, double tail);

/// The map turned into heights above `floor`: bright is near.
zbuffer::DepthMap heights(const zbuffer::DepthMap& map, double floor);

}  // namespace rejoin::report
