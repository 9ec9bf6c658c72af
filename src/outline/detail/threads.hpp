/// Hairs, loose threads and lines of the background that run out of a piece in a picture.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace rejoin::outline::detail {

/// What runs out of a piece.
struct Thread {
  cv::Point place;    ///< its pixel farthest from the piece
  double length = 0;  ///< along it, pixels
};

/// Takes off what hangs on wide pieces and is at most 4 pixels wide and so long that no tip of a piece is like it: an outline would run out along
/// it and back.
/// \param field  CV_32F, the pieces' border at 0.5; 0 afterwards where something was taken off
/// \return longest first
std::vector<Thread> take_off_threads(cv::Mat& field);

}  // namespace rejoin::outline::detail
