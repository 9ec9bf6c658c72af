/// Contours of a field by marching squares.
#pragma once

#include <glm/glm.hpp>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace rejoin::outline::detail {

/// Closed contours where a field passes a level, linear between pixel centres.  Beyond the border the field counts as
/// far below the level, so that every contour closes; a contour that follows the border keeps half a pixel outside.
/// What is above lies to the left with y drawn up: outer borders have positive shoelace area, holes negative.
/// \param field  CV_32F, one channel
/// \param least_points  shorter contours are left out
std::vector<std::vector<glm::dvec2>> contours(const cv::Mat& field, float level, std::size_t least_points);

/// By how much contours follow the pixels' steps, rms distance from the true border, pixels: 0 where each pixel's share of the
/// piece tells the border's place in it, 0.29 where pixels lie all in or all out.  Borders along the rows or columns have no
/// steps and do not count; 0 too if little else is left.
/// \param all  of contours()
double raster_of(const std::vector<std::vector<glm::dvec2>>& all);

}  // namespace rejoin::outline::detail
