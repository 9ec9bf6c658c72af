/// Pieces that are lighter than their background, as paper on a table: print that crosses their borders, and shadows beside them.
#pragma once

#include <opencv2/core/mat.hpp>

#include "outline/detail/foreground.hpp"

namespace rejoin::outline::detail {

/// Of those pieces that are lighter than the background for the most part; both are empty if there are none.
struct LightPaper {
  cv::Mat lit;  ///< CV_8U, 255 where it is lighter
  cv::Mat
      shadow;  ///< CV_8U, 255 along its border where it is not, wider than print, faint beside what is lit
};

/// \param faint  CV_8U, 255 where a pixel has less of the contrast than a border
LightPaper light_paper(const Foreground& found, const cv::Mat& faint);

/// Measures print that crosses the border against print: at half of what paper and print have on the mean, the border would run
/// inside the one and outside the other.
/// \param distance  from the background, CV_32F
/// \param contrast  distance that the piece beside a pixel has on the mean, CV_32F
/// \param lit       light_paper(), not empty
/// \param share     distance as a share of the contrast, 0 to 1, CV_32F; changed where there is print
void tell_print(const cv::Mat& distance, const cv::Mat& contrast, const cv::Mat& lit, cv::Mat& share);

}  // namespace rejoin::outline::detail
