/// What lies along the edges of a picture and is neither background nor piece.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace rejoin::outline::detail {

/// Lines of another colour along one to three whole edges of a picture whose other edges are background, as of a glass plate, a cut frame or a scanner's lid, up to 60 pixels and 5 %
/// of the picture's shorter side wide, get the colours of the lines behind them.
/// \param image  CV_32FC3, 0..1
/// \return a sentence that says which, for the user; empty if there are none
std::string paint_over_edges(cv::Mat& image);

}  // namespace rejoin::outline::detail
