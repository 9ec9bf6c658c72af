/// The white core of printed paper that shows along its tears.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace rejoin::outline::detail {

/// Takes torn paper's core off the pieces of a picture, each looked at alone.  A tear runs askew through the paper, so that one side keeps a rim of
/// its white core, of another width at every place, while the printed faces of both sides end along one line.  The core is bright, of one colour
/// without hue, lies along a part of the border, is narrow there, and is rare inside; an even margin stays, and so does all of a piece whose face is
/// as white, and of all pieces where their faces together are, or few of five and more show any.
/// \param image  CV_32F, 3 or 4 channels, 0..1   \param field  CV_32F, the pieces' border at 0.5; of what is left it is where the core's colour
/// has changed half-way to the face's
/// \return boxes around the pieces of which some was taken off
std::vector<cv::Rect> take_off_core(const cv::Mat& image, cv::Mat& field);

}  // namespace rejoin::outline::detail
