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

}  // namespace rejoin::outline::detail
