/// Where pieces that touch in a picture hang together.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace rejoin::outline::detail {

/// A place where a region is narrow between two parts that are wide.
struct Neck {
  cv::Point place;            ///< pixel at its middle
  double width = 0.0;         ///< pixels
  double wider = 0.0;         ///< so many times as wide is the largest disc of the narrower part
  std::vector<cv::Rect> cut;  ///< pixels that part the two if they are taken out, beside some of no region
};

/// Necks of the regions of a mask, those nearest to the top first.  Both parts are 2.5 times as wide as the neck or more.
/// \param mask   CV_8U, not 0 inside   \param least  area of a part's largest disc, at least, pixels
std::vector<Neck> necks(const cv::Mat& mask, double least);

}  // namespace rejoin::outline::detail
