/// Which pixels of a picture belong to a piece.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace rejoin::outline::detail {

/// How much each pixel belongs to a piece: CV_32F, the border of the pieces at 0.5.  From alpha where the picture has
/// transparent pixels; otherwise from the colour's distance to the background.
/// \param image  CV_32F, 3 or 4 channels, 0..1
/// \param path   for messages
/// \throws InputError nothing is opaque, or nothing stands out from the background, or the background is not plain
cv::Mat coverage(const cv::Mat& image, const std::string& path);

}  // namespace rejoin::outline::detail
