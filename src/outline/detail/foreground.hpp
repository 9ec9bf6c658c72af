/// Which pixels of a picture are pieces, by their colour before a background.
#pragma once

#include <opencv2/core/mat.hpp>

#include "outline/detail/background.hpp"

namespace rejoin::outline::detail {

/// How far each pixel's colour is from the background's, as it would be were all of the picture lit as its brightest frame.
/// \param image  CV_32FC3, 0..1   \return CV_32F
cv::Mat distance_from(const Background& background, const cv::Mat& image);

/// The regions of `soft` that touch `bare`; all CV_8U, 255 where they are.
cv::Mat touching(const cv::Mat& soft, const cv::Mat& bare);

struct Foreground {
  cv::Mat mask;    ///< CV_8U, 255 where a piece is, up to two pixels beyond its border
  cv::Mat shadow;  ///< CV_8U, 255 where background is in a shadow
  cv::Mat dim;     ///< CV_8U, 255 where no channel has more light than the background's
};

/// Pixels that differ from the background by more than it differs from itself.  Print and paint are often as near to the
/// background as to the rest of their piece, so what is asked is not which of the two a pixel is nearer to.  Shadows are
/// background: they darken it without another hue, and end slowly.
/// \param contrast   distance that pieces mostly have   \param most  distance that no background has
Foreground foreground(const Background& background, const cv::Mat& image, double contrast, double most);

/// Takes background in the outermost pixels off a foreground, which smoothing has drawn to them where a piece is a pixel or two away:
/// such a piece would seem to go on beyond the picture.
/// \param distance  of the picture as it is
void clear_frame(const cv::Mat& distance, cv::Mat& mask);

}  // namespace rejoin::outline::detail
