/// Which pixels of a picture belong to a piece.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace rejoin::outline::detail {

struct Coverage {
  cv::Mat field;     ///< CV_32F, how much each pixel belongs to a piece; the border of the pieces at 0.5
  cv::Mat distance;  ///< of each pixel's colour from the background's, 0 in a shadow; empty where alpha tells
  std::vector<std::string> notes;  ///< what was repaired or may be wrong, a sentence each; for the user
};

/// How much each pixel belongs to a piece.  From alpha where the picture has
/// transparent pixels; otherwise from the colour's distance to the background (detail::Background).
/// \param image  CV_32F, 3 or 4 channels, 0..1; without transparency, lines along its edges are painted over, see paint_over_edges()
/// \param path   for messages
/// \throws InputError nothing is opaque, or nothing stands out from the background, or the background is not plain
Coverage coverage(cv::Mat& image, const std::string& path);

}  // namespace rejoin::outline::detail
