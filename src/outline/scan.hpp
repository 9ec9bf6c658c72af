/// Scans of made pieces: what a scanner would give of a known border.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/random.hpp"

namespace rejoin::outline {

/// Points along the border about one pixel apart, from a random start, so that two scans of one border share no point.
/// Corners are cut by at most half a pixel.
/// \param border  closed, pixels
/// \param noise   deviation of each point from the border, along it and across it, pixels
std::vector<glm::dvec2> sample_border(const std::vector<glm::dvec2>& border, double noise, Random& random);

/// The outermost pixels of a scan in black and white: a pixel belongs to the piece if its centre lies inside the border.
/// In order around the piece (each next to the one before, across corners too), with positive shoelace area.
/// \source naiman 2018, section 4
std::vector<glm::dvec2> edge_pixels(const std::vector<glm::dvec2>& border);

/// Share of each pixel that lies inside the border, rows from the top, pixel centres at whole coordinates; what lies
/// beyond the picture is left out.
std::vector<float> pixel_coverage(const std::vector<glm::dvec2>& border, int width, int height);

}  // namespace rejoin::outline
